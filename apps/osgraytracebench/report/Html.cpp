// Html.cpp - marks, numbers and tables. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/Html.h"

#include <cmath>
#include <cstdio>

namespace osgRayTrace::bench
{

namespace
{

std::string row(const std::vector<std::string>& cells, const std::string& tag)
{
    std::string text = "<tr>";
    for (const std::string& cell : cells)
        text += "<" + tag + ">" + cell + "</" + tag.substr(0, 2) + ">";
    return text + "</tr>\n";
}

} // namespace

std::string escaped(const std::string& text)
{
    std::string result;
    for (const char c : text)
    {
        switch (c)
        {
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '&':
            result += "&amp;";
            break;
        case '"':
            result += "&quot;";
            break;
        default:
            result += c;
        }
    }
    return result;
}

std::string number(double value, const char* format)
{
    if (!std::isfinite(value)) return "&ndash;";
    char text[40];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string withError(double value, double error)
{
    return number(value, "%.3f") + " &plusmn; " + number(error, "%.3f");
}

std::string table(const std::vector<std::string>& headings,
                  const std::vector<std::vector<std::string>>& rows)
{
    std::string text = "<div class=wide tabindex=0><table><thead>" + row(headings, "th scope=col") +
                       "</thead><tbody>\n";
    for (const std::vector<std::string>& cells : rows)
        text += row(cells, "td");
    return text + "</tbody></table></div>\n";
}

} // namespace osgRayTrace::bench
