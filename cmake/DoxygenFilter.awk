# Completes the source for Doxygen, so that it can be brief. Line numbers stay.
# In public headers:
#   - The first line describes the file; the include guard is of no interest.
#   - A getter right below its documented setter, or below its documented other form, refers to that one.
#   - Copy constructors and members that override OpenSceneGraph's say so.
# In Markdown:
#   - Headings get GitHub's anchors, with the page before them: "## Light sizes {#settings-light-sizes}".
#   - Links to headings use these, and pictures are named as from the root of the source.
# SPDX-License-Identifier: MIT

function page_of(path)
{
    if (match(path, /(data|tests)\/README\.md$/)) # pages of equal names
        return tolower(substr(path, RSTART, index(substr(path, RSTART), "/") - 1)) "-readme"
    sub(/.*\//, "", path)
    sub(/\.md$/, "", path)
    return tolower(path)
}

function anchor_of(heading)
{
    heading = tolower(heading)
    gsub(/[^a-z0-9 _-]/, "", heading)
    gsub(/ /, "-", heading)
    return heading
}

FILENAME ~ /\.md$/ {
    if (/^```/) fenced = !fenced
    if (fenced) { print; next }
    if (/^##+ /)
    {
        heading = $0
        sub(/^#+ /, "", heading)
        $0 = $0 " {#" page_of(FILENAME) "-" anchor_of(heading) "}"
    }
    done = ""
    while (match($0, /\]\([A-Za-z\/._-]*(\.md)?#[a-z0-9_-]+\)/))
    {
        before = substr($0, 1, RSTART + 1)
        link = substr($0, RSTART + 2, RLENGTH - 3)
        $0 = substr($0, RSTART + RLENGTH)
        hash = index(link, "#")
        page = hash > 1 ? substr(link, 1, hash - 1) : FILENAME
        done = done before "#" page_of(page) "-" substr(link, hash + 1) ")"
    }
    $0 = done $0
    gsub(/(\.\.\/)+data\//, "data/")
    print
    next
}

/^#define OSGRAYTRACE_[A-Z_]+ 1$/ { print ""; next }

FNR == 1 && /^\/\/ [A-Za-z]+ - / {
    sub(/^\/\/ [A-Za-z]+ - /, "")
    print "/** \\brief " toupper(substr($0, 1, 1)) substr($0, 2) " \\file */"
    next
}

{
    line = $0
    below = above ~ /^ *\/\/\//
    documented = below || line ~ /\/\/\/</
    if (line ~ /^ *$/)
        described = ""
    else if (below && match(line, /[ &*][gs]et[A-Z][A-Za-z]*\(/))
        described = substr(line, RSTART + 1, RLENGTH - 2)
    else if (!documented && match(line, /[ &*]get[A-Z][A-Za-z]*\(\)/) && line ~ /([;}]|const)$/ &&
             substr(line, RSTART + 4, RLENGTH - 6) == substr(described, 4))
        line = line " ///< See " described "()."
    else if (!documented && line ~ /^ .* override( \{\}|;)$/)
        line = line " ///< Overrides the member of OpenSceneGraph's class."
    else if (!documented && line ~ /osg::CopyOp& copyop = .*\);$/)
        line = line " ///< Copies as copyop says."
    print line
    above = $0
}
