# A page of the manual from what `relief COMMAND --help` prints:
# awk -v command=run -v summary=... -v version=0.1.0 -v date=2026-01-31 -f page.awk. "" is relief(1).

# Text that troff prints as it stands; words in backticks bold.
function plain(text,    parts, count, i, out) {
    gsub(/\\/, "\\e", text)
    gsub(/-/, "\\-", text)
    gsub(/'/, "\\(aq", text)
    gsub(/\^/, "\\(ha", text)
    gsub(/~/, "\\(ti", text)
    count = split(text, parts, "`")
    out = parts[1]
    for (i = 2; i <= count; i++) {
        is_bold = !is_bold # over the end of a line, too
        out = out (is_bold ? "\\fB" : "\\fR") parts[i]
    }
    return out
}

# Prints text in lines of no more than 78 characters, none of which is taken for a request.
function say(text,    at) {
    while (text != "") {
        at = length(text) + 1
        if (at > 79) {
            for (at = 79; at > 1 && substr(text, at, 1) != " "; at--) {
            }
            at = at > 1 ? at : length(text) + 1
        }
        print (substr(text, 1, 1) == "." ? "\\&" : "") substr(text, 1, at - 1)
        text = substr(text, at + 1)
    }
}

function section(title) {
    print ".SH " title
    is_fresh = 1
    is_item = 0
}

# An empty line was there, and this is no first paragraph.
function paragraph() {
    if (is_parted && !is_fresh) {
        print ".PP"
    }
    is_parted = is_fresh = 0
}

# Where the meaning begins in "  --name ARGUMENT   meaning": behind two blanks, or the second word,
# or the first where that is no option.
function meaning_at(text,    at) {
    at = match(substr(text, 3), /  +[^ ]/)
    if (at > 0) {
        return at + 2 + RLENGTH - 1
    }
    if (text ~ /^  -/) {
        match(text, /^  [^ ]+ [^ ]+ /)
    } else {
        match(text, /^  [^ ]+ /)
    }
    return RLENGTH > 0 ? RLENGTH + 1 : length(text) + 1
}

# "  --name ARGUMENT   meaning": what is set off as a term, and its meaning below.
function item(text,    at, term, words, count, i) {
    at = meaning_at(text)
    term = substr(text, 3, at - 3)
    sub(/ +$/, "", term)
    count = split(term, words, " ")
    term = "\\fB" plain(words[1]) "\\fR"
    for (i = 2; i <= count; i++) {
        term = term " \\fI" plain(words[i]) "\\fR"
    }
    print ".TP\n" term
    column = at
    is_item = 1
    is_parted = is_fresh = 0
    say(plain(substr(text, at)))
}

# A line below an item; one that is set farther in is a list of its own.
function below(text,    at) {
    match(text, /^ +/)
    at = RLENGTH + 1
    sub(/^ +/, "", text)
    if (at > column + 1) {
        match(text, /^[^ ]+/)
        print ".br\n\\fB" plain(substr(text, 1, RLENGTH)) "\\fR"
        text = substr(text, RLENGTH + 1)
        sub(/^ +/, "", text)
    }
    say(plain(text))
}

BEGIN {
    page = command == "" ? "relief" : "relief-" command
    print ".\\\" Made by app/man/page.awk from the text of --help."
    print ".TH " toupper(plain(page)) " 1 " date " \"Relief " version "\" \"User Commands\""
    section("NAME")
    say(plain(page) " \\- " plain(summary))
}

# What stands before the usage.
!is_usage && !/^usage: / {
    about = about (about == "" || /^$/ ? "" : " ") plain($0)
    next
}

/^usage: / || (is_usage && /^       relief /) {
    if (is_usage) {
        print ".br"
    } else {
        section("SYNOPSIS")
    }
    is_usage = 1
    sub(/^(usage:)? +/, "")
    split($0, words, " ")
    name = command == "" ? words[1] : words[1] " " words[2]
    print "\\fB" plain(name) "\\fR" plain(substr($0, length(name) + 1))
    next
}

/^$/ {
    if (section_name == "") {
        section("DESCRIPTION")
        section_name = "DESCRIPTION"
        if (about != "") {
            say(about)
        }
    }
    is_parted = 1
    next
}

/^examples:$/ {
    section("EXAMPLES")
    section_name = "EXAMPLES"
    print ".EX"
    next
}

section_name == "EXAMPLES" && /^ / {
    sub(/^  /, "")
    print plain($0)
    next
}

section_name == "EXAMPLES" {
    print ".EE"
    section("EXIT STATUS")
    section_name = "EXIT STATUS"
    sub(/^.*Exit status: /, "")
}

/^commands:$/ {
    section("COMMANDS")
    section_name = "COMMANDS"
    next
}

/^[a-z].*:$/ && section_name == "COMMANDS" {
    sub(/:$/, "")
    print ".SS " toupper(substr($0, 1, 1)) plain(substr($0, 2))
    next
}

section_name == "COMMANDS" && /^  [a-z]/ {
    column = 13
    print ".TP\n.BR relief\\-" $1 " (1)"
    sub(/^ +[^ ]+ +/, "")
    say(plain($0))
    next
}

/^  -/ && section_name != "OPTIONS" {
    section("OPTIONS")
    section_name = "OPTIONS"
}

/^  [^ ]/ {
    item($0)
    next
}

/^   / && is_item {
    below($0)
    next
}

{
    is_item = 0
    sub(/^ +/, "")
    paragraph()
    say(plain($0))
}

END {
    if (section_name == "EXAMPLES") {
        print ".EE"
    }
    if (command != "") {
        section("SEE ALSO")
        print ".BR relief (1)"
    }
}
