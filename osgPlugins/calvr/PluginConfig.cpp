// PluginConfig.cpp - elements, options and lines of text. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "PluginConfig.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <locale>
#include <set>
#include <sstream>

namespace osgRayTrace::calvr
{

namespace
{

constexpr double kMostMilliseconds = 60000.0; // limit of frame-budget

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
    if (!(read > 0.0 && read <= kMostMilliseconds)) return false;
    value = read;
    return true;
}

/// Returns whether an option is each node's own: nodes may have more or fewer processors, and
/// render servers of their own.
bool isOfOneNode(const std::string& option)
{
    return option == "threads" || option == "frame-budget" || option == "servers";
}

const RayTraceSettings::Option* findOption(const std::vector<RayTraceSettings::Option>& options,
                                           const std::string& name)
{
    const auto found =
        std::find_if(options.begin(), options.end(),
                     [&](const RayTraceSettings::Option& option) { return option.name == name; });
    return found == options.end() ? nullptr : &*found;
}

/// Returns the name of an option's element: "FrameBudget" for "frame-budget".
std::string elementName(const std::string& option)
{
    std::string name;
    bool upper = true;
    for (const char c : option)
    {
        if (c != '-') name += upper && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
        upper = c == '-';
    }
    return name;
}

/// Returns a text that is equal for all spellings of an option's name.
std::string plainName(const std::string& name)
{
    std::string letters;
    for (const char c : name)
        if (c != '-' && c != '_')
            letters += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return letters;
}

} // namespace

osg::ref_ptr<RayTraceSettings> wallSettings()
{
    osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    const auto options = RayTraceSettings::options();
    const RayTraceSettings::Option* option = findOption(options, "equal-views");
    if (!option || !std::getenv(option->environment.c_str())) settings->setEqualViews(true);
    return settings;
}

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
        {
            taken = settings.set(name, value);
            if (taken) config.given.push_back(name);
        }
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

std::string makeEqualOnAllNodes(RayTraceSettings& settings, const PluginConfig& config)
{
    const auto options = RayTraceSettings::options();
    const auto isWanted = [&](const std::string& name)
    {
        const RayTraceSettings::Option* option = findOption(options, name);
        const std::string former = option ? plainName(option->formerName) : std::string();
        for (const std::string& given : config.given)
            if (plainName(given) == plainName(name) || plainName(given) == former) return true;
        return option && std::getenv(option->environment.c_str());
    };
    std::string overruled;
    const auto impose =
        [&](const std::string& name, const std::string& value, const std::string& reason)
    {
        const std::string wanted = settings.get(name);
        settings.set(name, value);
        if (wanted == settings.get(name) || !isWanted(name)) return;
        overruled += overruled.empty() ? "in a cluster " : "; ";
        overruled += elementName(name) + " '" + wanted + "' is overruled: " + reason;
    };
    impose("presentation", "frame-locked", "nodes show the same frame");
    impose("equal-views", "true", "nodes agree on passes and resolution");
    impose("passes-per-frame", "1", "nodes agree on them");
    impose("photon-guiding", "false", "nodes trace the same photons");
    std::ostringstream budget;
    budget.imbue(std::locale::classic());
    budget << config.clusterBudget;
    impose("frame-budget", budget.str(), "ClusterBudget holds, " + budget.str() + " ms");
    return overruled;
}

} // namespace osgRayTrace::calvr
