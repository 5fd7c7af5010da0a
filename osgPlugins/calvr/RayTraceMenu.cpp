// RayTraceMenu.cpp - check boxes that exclude each other. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "RayTraceMenu.h"

#include <cvrMenu/MenuSystem.h>

namespace osgRayTrace::calvr
{

RayTraceMenu::RayTraceMenu(cvr::MenuCallback& callback, osg::ref_ptr<RayTraceSettings> settings,
                           bool on, bool frozen)
    : _settings(std::move(settings)),
      _menu(std::make_unique<cvr::SubMenu>("Ray tracing")),
      _on(std::make_unique<cvr::MenuCheckbox>("On", on)),
      _freeze(std::make_unique<cvr::MenuCheckbox>("Freeze head", frozen)),
      _report(std::make_unique<cvr::MenuButton>("Print report"))
{
    _on->setCallback(&callback);
    _menu->addItem(_on.get());
    for (const MenuChoice& choice : menuChoices())
        addChoice(choice, callback);
    _freeze->setCallback(&callback);
    _menu->addItem(_freeze.get());
    _report->setCallback(&callback);
    _menu->addItem(_report.get());
    cvr::MenuSystem::instance()->addMenuItem(_menu.get());
}

/// Removes the menu, but leaves the items to the end of the process: when an item is deleted which
/// CalVR's board menu has drawn, the menu reads past an element of a map that it has just erased.
/// CalVR deletes plugins at its own end alone; no item calls back any more.
RayTraceMenu::~RayTraceMenu()
{
    cvr::MenuSystem::instance()->removeMenuItem(_menu.get());
    for (Lines& lines : _lines)
    {
        for (auto& box : lines.boxes)
            box.release()->setCallback(nullptr);
        lines.menu.release();
    }
    _report.release()->setCallback(nullptr);
    _freeze.release()->setCallback(nullptr);
    _on.release()->setCallback(nullptr);
    _menu.release();
}

void RayTraceMenu::addChoice(const MenuChoice& choice, cvr::MenuCallback& callback)
{
    Lines lines{choice, std::make_unique<cvr::SubMenu>(choice.title), {}};
    for (const MenuEntry& entry : choice.entries)
    {
        lines.boxes.push_back(std::make_unique<cvr::MenuCheckbox>(entry.label, false));
        lines.boxes.back()->setCallback(&callback);
        lines.menu->addItem(lines.boxes.back().get());
    }
    showChosen(lines);
    _menu->addItem(lines.menu.get());
    _lines.push_back(std::move(lines));
}

void RayTraceMenu::showChosen(const Lines& lines)
{
    const int chosen = chosenEntry(lines.choice, *_settings);
    for (size_t i = 0; i < lines.boxes.size(); ++i)
        lines.boxes[i]->setValue(static_cast<int>(i) == chosen);
}

/// Sets the item only if it changes: an item that is set is drawn again.
void RayTraceMenu::showFrozen(bool frozen)
{
    if (_freeze->getValue() != frozen) _freeze->setValue(frozen);
}

void RayTraceMenu::clicked(const cvr::MenuItem* item)
{
    for (const Lines& lines : _lines)
        for (size_t i = 0; i < lines.boxes.size(); ++i)
        {
            if (lines.boxes[i].get() != item) continue;
            choose(lines.choice.entries[i], *_settings);
            showChosen(lines);
            return;
        }
}

} // namespace osgRayTrace::calvr
