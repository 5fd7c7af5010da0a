// MenuChoices.h - what the menu offers, as settings. Layer: plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTraceSettings>

#include <string>
#include <utility>
#include <vector>

namespace osgRayTrace::calvr
{

/// One line of a submenu: options and their values.
struct MenuEntry
{
    std::string label;
    std::vector<std::pair<std::string, std::string>> values;
};

/// A submenu of which one line is chosen.
struct MenuChoice
{
    std::string title;
    std::vector<MenuEntry> entries;
};

/// Integrator, light sampling, photons a pass, quality.
std::vector<MenuChoice> menuChoices();

void choose(const MenuEntry& entry, RayTraceSettings& settings);

/// Index of the entry whose values the settings have; -1: they have others.
int chosenEntry(const MenuChoice& choice, const RayTraceSettings& settings);

} // namespace osgRayTrace::calvr
