# ManualPage.awk - makes a manual page of what a program prints for --help.
# Usage: PROGRAM --help | awk -f ManualPage.awk -v name=PROGRAM -v brief=SENTENCE -v version=VERSION
# Entries are lines that begin with two blanks, a name and, behind two blanks or on lines of their own, its text.
# SPDX-License-Identifier: MIT

function escaped(text)
{
    gsub(/\\/, "\\e", text)
    gsub(/-/, "\\-", text)
    return text
}

# Prints text; a dot or a quote at the beginning of a line is no command.
function say(text)
{
    sub(/^ +/, "", text)
    sub(/ +$/, "", text)
    text = escaped(text)
    if (text ~ /^[.']/) text = "\\&" text
    if (text != "") print text
}

# Begins OPTIONS in front of its first entry, and describes the program before.
function begin()
{
    if (begun) return
    begun = 1
    print ".SH OPTIONS"
}

BEGIN {
    printf ".TH %s 1 \"\" \"osgRayTrace %s\" \"User Commands\"\n", toupper(name), version
    printf ".SH NAME\n%s \\- %s\n", escaped(name), escaped(brief)
    print ".SH SYNOPSIS"
}

# A path before the program's name is that of the build.
{ gsub("[^ ]*/" name, name) }

/^Usage: / || (usage && /^       [^ ]/) {
    sub(/^Usage: /, "")
    sub(/^ +/, "")
    if (usage++) print ".br"
    printf ".B %s\n", escaped($0)
    next
}
{ if (usage) usage = -1 }

/^[A-Z][A-Za-z ]*:$/ {
    begin()
    sub(/:$/, "")
    printf ".SS %s\n", escaped($0)
    entry = 0
    next
}

/^  [^ ]/ {
    begin()
    entry = 1
    line = substr($0, 3)
    gap = match(line, /  +/)
    print ".TP"
    printf ".B %s\n", escaped(gap ? substr(line, 1, gap - 1) : line)
    if (gap) say(substr(line, gap))
    next
}

/^ *$/ { entry = 0; next }

/^   / && entry { say($0); next }

# Sentences before the usage describe the program, and those behind the options follow them.
{
    if (!usage) description = description (description == "" ? "" : " ") $0
    else if (!begun) description = description (description == "" ? "" : " ") $0
    else
    {
        if (!entry) print ".PP"
        entry = 1
        say($0)
    }
}

END {
    if (description != "")
    {
        print ".SH DESCRIPTION"
        say(description)
    }
    print ".SH SEE ALSO"
    print "The documents of osgRayTrace, in the package osgraytrace\\-doc of Debian or in the folder"
    print ".I share/osgRayTrace"
    print "of an installation."
}
