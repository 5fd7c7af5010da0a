// MenuChoices.cpp - the lines of the menu. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "MenuChoices.h"

#include <sstream>

namespace osgRayTrace::calvr
{

namespace
{

/// Returns a submenu of all words of an option that is a choice.
MenuChoice choiceOf(const std::string& title, const std::string& name)
{
    MenuChoice choice{title, {}};
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
    {
        if (option.name != name) continue;
        std::istringstream words(option.range);
        std::string word;
        while (std::getline(words, word, '|'))
            choice.entries.push_back({word, {{name, word}}});
    }
    return choice;
}

/// Returns a submenu in which each step takes four times as long and leaves half of the noise that
/// photons make.
MenuChoice photonChoice()
{
    MenuChoice choice{"Photons a pass", {}};
    for (int photons = 1 << 12; photons <= 1 << 22; photons *= 4)
    {
        const std::string label = photons < 1 << 20 ? std::to_string(photons >> 10) + " k"
                                                    : std::to_string(photons >> 20) + " M";
        choice.entries.push_back({label, {{"photons", std::to_string(photons)}}});
    }
    return choice;
}

MenuChoice qualityChoice()
{
    return {"Quality",
            {{"Draft", {{"light-samples", "1"}, {"max-bounces", "3"}}},
             {"Normal", {{"light-samples", "4"}, {"max-bounces", "8"}}},
             {"High", {{"light-samples", "16"}, {"max-bounces", "16"}}}}};
}

} // namespace

std::vector<MenuChoice> menuChoices()
{
    return {choiceOf("Integrator", "integrator"), choiceOf("Light sampling", "light-sampling"),
            photonChoice(), qualityChoice()};
}

void choose(const MenuEntry& entry, RayTraceSettings& settings)
{
    for (const auto& [option, value] : entry.values)
        settings.set(option, value);
}

int chosenEntry(const MenuChoice& choice, const RayTraceSettings& settings)
{
    for (size_t i = 0; i < choice.entries.size(); ++i)
    {
        bool equal = true;
        for (const auto& [option, value] : choice.entries[i].values)
            equal = equal && settings.get(option) == value;
        if (equal) return static_cast<int>(i);
    }
    return -1;
}

} // namespace osgRayTrace::calvr
