// Parameters.cpp - splits names, and sets options by their parameters. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "Parameters.h"

#include <sstream>

using osgRayTrace::RayTraceSettings;
using osgRayTrace::SceneLights;

namespace
{

/// Returns the position of the last dot outside of brackets that is not part of a directory; npos:
/// none.
std::string::size_type lastDot(const std::string& name)
{
    int depth = 0;
    for (std::string::size_type i = name.size(); i-- > 0;)
    {
        const char c = name[i];
        if (c == ')' || c == ']') ++depth;
        if (c == '(' || c == '[') --depth;
        if (depth > 0) continue;
        if (c == '.') return i;
        if (c == '/' || c == '\\') break;
    }
    return std::string::npos;
}

bool isBracketed(const std::string& text)
{
    if (text.size() < 2) return false;
    return (text.front() == '(' && text.back() == ')') ||
           (text.front() == '[' && text.back() == ']');
}

std::string trimmed(const std::string& text)
{
    const auto begin = text.find_first_not_of(" \t");
    if (begin == std::string::npos) return std::string();
    return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

bool setWord(RayTraceSettings& settings, const std::string& word)
{
    if (settings.set("integrator", word)) return true;
    return settings.set("debug-channel", word) && settings.set("integrator", "debug");
}

bool isWord(const std::string& text)
{
    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    return setWord(*settings, text);
}

/// Returns the range of an option, as " (1 .. 4096)"; empty for a name that is spelt in another way
/// than in the table.
std::string rangeOf(const std::string& name)
{
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
    {
        if (option.name == name) return " (" + option.range + ")";
    }
    return std::string();
}

/// Sets one item of applyParameters.
std::string applyItem(const std::string& item, RayTraceSettings& settings, SceneLights& lights)
{
    const auto equals = item.find('=');
    if (equals == std::string::npos)
        return setWord(settings, item) ? std::string()
                                       : "'" + item + "' is no integrator and no option=value";

    const std::string name = trimmed(item.substr(0, equals));
    const std::string value = trimmed(item.substr(equals + 1));
    if (SceneLights::knows(name))
        return lights.set(name, value) ? std::string()
                                       : "option '" + name + "' cannot be '" + value + "'";
    if (settings.get(name).empty()) return "there is no option '" + name + "'";
    if (settings.set(name, value)) return std::string();
    return "option '" + name + "' cannot be '" + value + "'" + rangeOf(name);
}

} // namespace

NameParts splitName(const std::string& name)
{
    const auto dot = lastDot(name);
    if (dot == std::string::npos) return {name, std::string()};

    const std::string last = name.substr(dot + 1);
    const std::string file = name.substr(0, dot);
    if (isBracketed(last)) return {file, last.substr(1, last.size() - 2)};
    if (last.find('=') != std::string::npos || isWord(last)) return {file, last};
    return {name, std::string()};
}

std::string applyParameters(const std::string& parameters, RayTraceSettings& settings,
                            SceneLights& lights)
{
    std::istringstream list(parameters);
    std::string item;
    while (std::getline(list, item, ','))
    {
        const std::string error = applyItem(trimmed(item), settings, lights);
        if (!error.empty()) return error;
    }
    return std::string();
}
