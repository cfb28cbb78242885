# Writes all numbers of the structs that a caller fills in, so that no field of the headers escapes
# tests/unit/test_def_fields.c: awk -v STRUCTS="rlf_x_def ..." -f comments.awk
# -f def_fields.awk HEADER... > def_fields.h

# Every number below `path`, a field of struct `root` that is of type `type`.
function write_fields(root, type, path,    list, count, i, words, kind, name, size, k, dot, n, names) {
    if (type in is_enum) { kind = "FIELD_ENUM" }
    else if (type == "ptrdiff_t") { kind = "FIELD_INT64_T" }
    else if (type ~ /^(double|float|int32_t|int64_t)$/) { kind = "FIELD_" toupper(type) }
    if (kind != "") {
        printf "    {\"%s\", offsetof(%s, %s), %s},\n", path, root, path, kind
        total++
        return
    }
    if (!(type in body)) { return }
    dot = path == "" ? "" : path "."
    count = split(body[type], list, ";")
    for (i = 1; i <= count; i++) {
        if (list[i] ~ /[*(]/) { continue }
        gsub(/^ +| +$/, "", list[i])
        sub(/^const /, "", list[i])
        sub(/^struct /, "", list[i])
        kind = list[i]
        sub(/ .*/, "", kind)
        if (list[i] == "" || kind == "char") { continue }
        names = substr(list[i], length(kind) + 2)
        n = split(names, words, ",")
        for (k = 1; k <= n; k++) {
            name = words[k]
            gsub(/ /, "", name)
            size = name
            if (sub(/.*\[/, "", size)) {
                sub(/\]/, "", size)
                sub(/\[.*/, "", name)
                write_fields(root, kind, dot name "[0]")
                if (size ~ /^[0-9]+$/ && size > 1) { write_fields(root, kind, dot name "[" size - 1 "]") }
            } else {
                write_fields(root, kind, dot name)
            }
        }
    }
}

FNR == 1 { is_inside = 0 }

{
    code = code_of($0)
    if (code ~ /^typedef enum [a-z0-9_]+/) { is_enum[$3] = 1 }
    if (code ~ /^typedef struct [a-z0-9_]+ *\{/) {
        name = $3
        is_open = 1
        next
    }
    if (is_open && code ~ /^\}/) { is_open = 0 }
    if (is_open) { body[name] = body[name] " " code }
}

END {
    print "/* Made by def_fields.awk. */"
    count = split(STRUCTS, roots, " ")
    for (r = 1; r <= count; r++) {
        if (!(roots[r] in body)) {
            print "def_fields: there is no struct " roots[r] > "/dev/stderr"
            exit 1
        }
        printf "static const def_field fields_%s[] = {\n", roots[r]
        total = 0
        write_fields(roots[r], roots[r], "")
        printf "};\nenum { COUNT_%s = %d };\n", roots[r], total
    }
}
