# Completes the comments of a public header for Doxygen, so that the source can be brief. Line numbers stay.
#   - A getter right below its documented setter, or below its documented other form, refers to that one.
#   - Copy constructors and members that override OpenSceneGraph's say so.
# SPDX-License-Identifier: MIT

# Markdown passes as it is.
FILENAME ~ /\.md$/ { print; next }

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
