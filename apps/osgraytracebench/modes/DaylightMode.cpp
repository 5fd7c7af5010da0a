// DaylightMode.cpp - error and cost of rooms with a window, skies and large panels. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/DaylightMode.h"

#include "apps/osgraytracebench/modes/PathImages.h"
#include "apps/osgraytracebench/scenes/DaylightScenes.h"

namespace osgRayTrace::bench
{

namespace
{

constexpr int kWidth = 256, kHeight = 160, kPairs = 2;

struct Part
{
    const char* name;
    BenchScene (*scene)(int width, int height);
    double goal; ///< relMSE x s; 0: none
};

const Part kParts[] = {
    {"window, open", [](int w, int h) { return windowRoom(Sky::Sunny, Glazing::Open, w, h); }, 0.2},
    {"window, pane", [](int w, int h) { return windowRoom(Sky::Sunny, Glazing::Pane, w, h); }, 0.0},
    {"window, two panes", [](int w, int h) { return windowRoom(Sky::Sunny, Glazing::Panes, w, h); },
     0.0},
    {"window, box of glass",
     [](int w, int h) { return windowRoom(Sky::Sunny, Glazing::Box, w, h); }, 0.0},
    {"window, even sky", [](int w, int h) { return windowRoom(Sky::Even, Glazing::Open, w, h); },
     0.0},
    {"ground, sunny sky", [](int w, int h) { return openGround(Sky::Sunny, w, h); }, 0.0},
    {"ground, even sky", [](int w, int h) { return openGround(Sky::Even, w, h); }, 0.0},
    {"panel, rectangle", [](int w, int h) { return panelRoom(false, w, h); }, 0.0},
    {"panel, skewed", [](int w, int h) { return panelRoom(true, w, h); }, 0.0},
    {"Cornell box", cornellBox, 0.0},
};

} // namespace

void measureDaylight(const std::string& only, Rows& rows)
{
    double open = 0.0;
    for (const Part& part : kParts)
    {
        const std::string name = part.name;
        if (name.find(only) == std::string::npos) continue;
        const double product =
            measureImage(name, part.scene(kWidth, kHeight), part.goal, rows, kPairs).product;
        if (name == "window, open") open = product;
        if (name == "window, pane" && open > 0.0)
            rows.push_back(
                {"window: relMSE x s with a pane / open", product / open, "", Goal::AtMost, 1.5});
    }
}

} // namespace osgRayTrace::bench
