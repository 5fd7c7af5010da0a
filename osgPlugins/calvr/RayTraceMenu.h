// RayTraceMenu.h - the plugin's submenu in CalVR's menu. Layer: plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "MenuChoices.h"

#include <cvrMenu/MenuButton.h>
#include <cvrMenu/MenuCheckbox.h>
#include <cvrMenu/SubMenu.h>

#include <memory>
#include <vector>

namespace osgRayTrace::calvr
{

/// Offers the settings in submenus of check boxes, which all of CalVR's menus can show. The menu
/// shows and changes the settings; its owner asks for the other states.
class RayTraceMenu
{
public:
    /// Adds the menu to CalVR's main menu. callback: callback of all items.
    RayTraceMenu(cvr::MenuCallback& callback, osg::ref_ptr<RayTraceSettings> settings, bool on,
                 bool frozen);
    ~RayTraceMenu();
    RayTraceMenu(const RayTraceMenu&) = delete;
    RayTraceMenu& operator=(const RayTraceMenu&) = delete;

    /// Changes the settings if item is one of their lines.
    void clicked(const cvr::MenuItem* item);

    bool isOn() const { return _on->getValue(); }
    bool isFrozen() const { return _freeze->getValue(); }
    bool isFreeze(const cvr::MenuItem* item) const { return item == _freeze.get(); }
    void showFrozen(bool frozen);
    bool isReport(const cvr::MenuItem* item) const { return item == _report.get(); }

private:
    struct Lines
    {
        MenuChoice choice;
        std::unique_ptr<cvr::SubMenu> menu;
        std::vector<std::unique_ptr<cvr::MenuCheckbox>> boxes; ///< one box for each entry
    };

    void addChoice(const MenuChoice& choice, cvr::MenuCallback& callback);
    void showChosen(const Lines& lines);

    osg::ref_ptr<RayTraceSettings> _settings;
    std::unique_ptr<cvr::SubMenu> _menu;
    std::unique_ptr<cvr::MenuCheckbox> _on;
    std::unique_ptr<cvr::MenuCheckbox> _freeze;
    std::unique_ptr<cvr::MenuButton> _report;
    std::vector<Lines> _lines;
};

} // namespace osgRayTrace::calvr
