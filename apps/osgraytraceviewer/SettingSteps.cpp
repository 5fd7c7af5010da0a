// SettingSteps.cpp - the next and the last value of a setting. Layer: apps.
// SPDX-License-Identifier: MIT
#include "SettingSteps.h"

#include "osgRayTrace/base/NumberText.h"

#include <algorithm>
#include <vector>

namespace osgRayTrace::app
{

namespace
{

constexpr float kExposureStep = 0.5f; ///< [EV]

std::vector<std::string> wordsOf(const std::string& range)
{
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin <= range.size();)
    {
        const std::size_t end = std::min(range.find('|', begin), range.size());
        words.push_back(range.substr(begin, end - begin));
        begin = end + 1;
    }
    return words;
}

/// Returns the word after the present one, or before it, around the ends.
std::string nextOf(const std::vector<std::string>& words, const std::string& now, bool up)
{
    const auto found = std::find(words.begin(), words.end(), now);
    if (found == words.end()) return words.front();
    const auto index = static_cast<std::size_t>(found - words.begin());
    return words[(index + (up ? 1 : words.size() - 1)) % words.size()];
}

} // namespace

void stepSetting(RayTraceSettings& settings, const std::string& name, bool up)
{
    const std::string now = settings.get(name);
    if (name == "exposure")
        return settings.setExposure(settings.getExposure() + (up ? kExposureStep : -kExposureStep));
    if (name == "ground") return settings.setGround(now == "none" ? "auto" : "none");
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
    {
        if (option.name != name) continue;
        const auto number = engine::parseNumber<int>(now);
        if (!number)
        {
            settings.set(name, nextOf(wordsOf(option.range), now, up));
            return;
        }
        const bool doubles = name == "max-passes" || name == "light-samples";
        const int next = doubles ? (up ? 2 * *number : *number / 2) : *number + (up ? 1 : -1);
        settings.set(name, std::to_string(next)); // out of range: it stays
        return;
    }
}

} // namespace osgRayTrace::app
