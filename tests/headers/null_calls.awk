# Writes one call of every public function for each of its pointers, which is then NULL, so that no
# function of the headers escapes tests/unit/test_null_calls.c:
# awk -v MAY_BE_NULL=may_be_null.txt -f comments.awk -f null_calls.awk HEADER... > null_calls.h

function fail(line) {
    print "null_calls: " line > "/dev/stderr"
    failed = 1
    exit 1
}

# What a call gives when it does nothing, as an expression.
function is_nothing(type, call) {
    if (type == "rlf_result") { return call " == RLF_ERROR_INVALID" }
    if (type == "rlf_query_reason") { return call " == RLF_QUERY_INVALID" }
    if (type ~ /\*/) { return call " == NULL" }
    if (type == "void" || type in is_struct) { return "((void)" call ", true)" }
    return call " == 0"
}

# An argument that is all right, of type and name.
function valid(type, name,    base, stars, number) {
    base = " " type " "
    stars = gsub(/\*/, " ", base)
    while (sub(/ (const|struct) /, " ", base)) { }
    gsub(/ /, "", base)
    if (type in is_function) { return "fn_" type }
    if (base == "int32_t") { number = 4 } else { number = base in is_struct ? 0 : 1 }
    if (!stars) { return "(" base "){" number "}" }
    if (!(base in seen)) {
        seen[base] = 1
        printf "#ifndef VALID_%s\n#define VALID_%s blank(sizeof(%s))\n#endif\n", base, base, base
    }
    if (stars == 1) { return "VALID_" base }
    return name ~ /^out/ ? "slot(NULL)" : "slot(VALID_" base ")"
}

function write_function(text,    open, head, type, name, list, count, i, words, arg, pointers, names, flags, call, key) {
    open = index(text, "(")
    head = substr(text, 1, open - 1)
    list = substr(text, open + 1)
    sub(/\).*/, "", list)
    name = head
    sub(/.*[ *]/, "", name)
    type = substr(head, 1, length(head) - length(name))
    gsub(/^ +| +$/, "", type)
    count = split(list, words, ",")
    call = ""
    pointers = 0
    names = ""
    flags = ""
    for (i = 1; i <= count; i++) {
        arg = words[i]
        gsub(/^ +| +$/, "", arg)
        if (arg == "void" || arg == "...") { continue }
        key = arg
        sub(/.*[ *]/, "", key)
        arg = substr(arg, 1, length(arg) - length(key))
        gsub(/ +$/, "", arg)
        if (call != "") { call = call ", " }
        if (arg ~ /\*/ || arg in is_function) {
            known[name " " key] = 1
            call = call "k == " pointers " || k == -1 ? NULL : " valid(arg, key)
            names = names "\"" key "\", "
            flags = flags ((name " " key) in may_be_null ? "true, " : "false, ")
            pointers++
        } else {
            call = call valid(arg, key)
        }
    }
    if (!pointers) { return }
    total++
    printf "static bool call_%s(int k)\n{\n    return %s;\n}\n", name, is_nothing(type, name "(" call ")")
    entries = entries sprintf("    {\"%s\", call_%s, %d, {%s}, {%s}},\n", name, name, pointers, names, flags)
}

BEGIN {
    while ((getline line < MAY_BE_NULL) > 0) {
        if (line !~ /^#/ && line != "") {
            split(line, words, " ")
            may_be_null[words[1] " " words[2]] = 1
        }
    }
}

FNR == 1 {
    is_inside = 0
    name = FILENAME
    sub(/.*\//, "", name)
    includes = includes "#include \"relief/" name "\"\n"
}

{
    code = code_of($0)
    if (code ~ /^typedef struct [a-z0-9_]+ *\{/) { is_struct[$3] = 1 }
    if (code ~ /^typedef .*\(\*rlf_/) {
        name = code
        sub(/.*\(\*/, "", name)
        sub(/\).*/, "", name)
        is_function[name] = 1
    }
    if (code ~ /^RLF_API /) {
        sub(/^RLF_API /, "", code)
        is_open = 1
    } else if (code ~ /^static inline /) {
        sub(/^static inline /, "", code)
        is_open = 1
    }
    if (is_open) {
        text = text " " code
        if (code ~ /[;{]/) {
            functions[++function_count] = text
            text = ""
            is_open = 0
        }
    }
}

END {
    if (failed) { exit 1 }
    print "/* Made by null_calls.awk. */"
    printf "%s", includes
    for (i = 1; i <= function_count; i++) { write_function(functions[i]) }
    for (key in may_be_null) {
        if (!(key in known) && !(PARTIAL)) { fail("may_be_null.txt: no such argument: " key) }
    }
    if (total < 30) { fail("only " total " functions: are they declared otherwise now?") }
    printf "static const null_call null_calls[] = {\n%s};\n", entries
}
