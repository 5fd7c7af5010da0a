# table.sh - the table of pictures of run.sh, which sources this file.
# SPDX-License-Identifier: MIT

escape()
{
    sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g'
}

# pictures NAME prints the windows' pictures: plain, traced, and four times the difference.
pictures()
{
    local plain number
    for plain in "$OUT/$1"/plain[0-9]*.png; do
        [ -e "$plain" ] || continue
        number=${plain##*/plain}
        printf '<div>'
        for kind in plain traced difference; do
            printf '<img src="%s/%s%s" alt="%s">' "$1" "$kind" "$number" "$kind"
        done
        printf '</div>\n'
    done
}

# table_row NAME prints the row of a program.
table_row()
{
    WORK=$OUT/$1
    printf '<tr><td><b>%s</b><br><code>%s</code><br>%s' "$1" "$(row "$1" 2 | escape)" "$(escape <"$WORK/verdict")"
    if [ -e "$WORK/plain.exit" ]; then
        printf '<br>exit %s, %s<br>frames %s, %s<br>ms %s, %s<br>difference %s of %s' \
            "$(cat "$WORK/plain.exit")" "$(cat "$WORK/traced.exit")" "$(value plain frames)" "$(value traced frames)" \
            "$(value plain milliseconds)" "$(value traced milliseconds)" "$(cat "$WORK/difference")" "$(row "$1" 3)"
        [ ! -e "$WORK/traced.leaves" ] || printf '<br>leaves %s: traced %s, OSG draws %s, empty %s, other passes %s, lost %s' \
            "$(leaves leaves)" "$(leaves traced)" "$(leaves drawn)" "$(leaves empty)" "$(leaves other-passes)" "$(leaves lost)"
    fi
    printf '<br><i>%s</i></td><td>' "$(row "$1" 4 | escape)"
    pictures "$1"
    printf '</td><td><pre>'
    cat "$WORK/report.txt" 2>/dev/null | escape
    printf '</pre></td></tr>\n'
}

# write_table prints the page. The figures of a row are those of the plain program, then of the traced one.
write_table()
{
    cat <<'END'
<!DOCTYPE html>
<meta charset="utf-8"><title>OSG programs with osgraytrace-run</title>
<style>
body { font: 14px sans-serif } td { vertical-align: top; border-top: 1px solid; padding: 4px }
img { width: 240px } pre { font-size: 11px; max-height: 260px; overflow: auto } td:first-child { width: 260px }
</style>
<h1>OSG programs: plain, with osgraytrace-run, and four times the difference</h1>
<table>
END
    local name
    for name in "${NAMES[@]}"; do
        table_row "$name"
    done
    echo '</table>'
}
