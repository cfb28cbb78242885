# Without comments; `is_inside` is a comment that goes on.
function code_of(line,    code, begin, end) {
    code = ""
    while (line != "") {
        if (is_inside) {
            end = index(line, "*/")
            if (!end) { break }
            line = substr(line, end + 2)
            is_inside = 0
        } else {
            begin = index(line, "/*")
            if (!begin) { return code line }
            code = code substr(line, 1, begin - 1)
            line = substr(line, begin + 2)
            is_inside = 1
        }
    }
    return code
}
