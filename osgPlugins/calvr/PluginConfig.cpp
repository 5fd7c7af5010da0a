// PluginConfig.cpp - elements, options and lines of text. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "PluginConfig.h"

#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

namespace osgRayTrace::calvr
{

namespace
{

bool readSwitch(const std::string& text, bool& value)
{
    std::string word = text;
    for (char& c : word)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const bool on = word == "on" || word == "true" || word == "yes" || word == "1";
    const bool off = word == "off" || word == "false" || word == "no" || word == "0";
    if (on || off) value = on;
    return on || off;
}

bool readMilliseconds(const std::string& text, double& value)
{
    double read = 0.0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), read);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return false;
    if (!(read > 0.0) || !std::isfinite(read)) return false;
    value = read;
    return true;
}

/// Nodes may have more or fewer processors.
bool isOfOneNode(const std::string& option)
{
    return option == "threads";
}

} // namespace

PluginConfig readConfig(const std::vector<std::string>& names,
                        const std::function<std::string(const std::string& name)>& valueOf,
                        RayTraceSettings& settings)
{
    PluginConfig config;
    std::set<std::string> seen; // valueOf has one value for a name
    for (const std::string& name : names)
    {
        if (!seen.insert(name).second) continue;
        const std::string value = valueOf(name);
        bool taken = false;
        if (name == "Trace")
            taken = readSwitch(value, config.trace);
        else if (name == "ClusterBudget")
            taken = readMilliseconds(value, config.clusterBudget);
        else if (settings.get(name).empty())
        {
            config.complaints.push_back("there is no option '" + name + "'");
            continue;
        }
        else
            taken = settings.set(name, value);
        if (!taken) config.complaints.push_back("'" + name + "' cannot be '" + value + "'");
    }
    return config;
}

std::string sharedSettings(const RayTraceSettings& settings, const PluginConfig& config)
{
    std::string lines = std::string("trace=") + (config.trace ? "on" : "off") + "\n";
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
    {
        if (isOfOneNode(option.name)) continue;
        lines += option.name + "=" + settings.get(option.name) + "\n";
    }
    return lines;
}

std::vector<std::string> takeSharedSettings(const std::string& lines, RayTraceSettings& settings,
                                            PluginConfig& config)
{
    std::vector<std::string> complaints;
    std::istringstream stream(lines);
    std::string line;
    while (std::getline(stream, line))
    {
        const auto equals = line.find('=');
        const std::string name = line.substr(0, equals);
        const std::string value =
            equals == std::string::npos ? std::string() : line.substr(equals + 1);
        const bool taken = name == "trace" ? readSwitch(value, config.trace)
                                           : !isOfOneNode(name) && settings.set(name, value);
        if (!taken) complaints.push_back("the master's '" + line + "' is no setting here");
    }
    return complaints;
}

void makeEqualOnAllNodes(RayTraceSettings& settings)
{
    settings.setAimAtViews(false);
    settings.set("frame-budget", "0");
}

} // namespace osgRayTrace::calvr
