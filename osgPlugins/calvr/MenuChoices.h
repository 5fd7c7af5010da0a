// MenuChoices.h - the lines of the menu, as settings. Layer: plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTraceSettings>

#include <string>
#include <utility>
#include <vector>

namespace osgRayTrace::calvr
{

/// Describes one line of a submenu: options and their values.
struct MenuEntry
{
    std::string label;
    std::vector<std::pair<std::string, std::string>> values;
};

/// Describes a submenu of which one line is chosen.
struct MenuChoice
{
    std::string title;
    std::vector<MenuEntry> entries;
};

/// Returns the submenus: integrator, light sampling, photons a pass, quality.
std::vector<MenuChoice> menuChoices();

void choose(const MenuEntry& entry, RayTraceSettings& settings);

/// Returns the index of the entry whose values the settings have; -1: they have others.
int chosenEntry(const MenuChoice& choice, const RayTraceSettings& settings);

} // namespace osgRayTrace::calvr
