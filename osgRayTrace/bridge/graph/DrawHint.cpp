// DrawHint.cpp - reads and writes hints in the descriptions of nodes. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/DrawHint.h"

#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <algorithm>
#include <string>
#include <string_view>

namespace osgRayTrace::engine
{

namespace
{

constexpr std::string_view kPrefix = "osgRayTrace:";

struct HintWord
{
    const char* word;
    DrawHint hint;
};

constexpr HintWord kWords[] = {{"automatic", DrawHint::Automatic},
                               {"trace", DrawHint::Trace},
                               {"rasterize", DrawHint::Rasterize},
                               {"rasterize-only", DrawHint::RasterizeOnly}};

bool isHint(const std::string& description)
{
    return description.compare(0, kPrefix.size(), kPrefix) == 0;
}

} // namespace

DrawHint ownHint(const osg::Node& node)
{
    if (!node.getUserDataContainer()) return DrawHint::None; // almost all nodes have none
    for (unsigned int i = 0; i < node.getNumDescriptions(); ++i)
    {
        const std::string& description = node.getDescription(i);
        if (!isHint(description)) continue;
        for (const HintWord& known : kWords)
            if (description.compare(kPrefix.size(), std::string::npos, known.word) == 0)
                return known.hint;
        warnOnce("node '" + node.getName() + "': description '" + description +
                 "' is no hint: the hints are trace, rasterize, rasterize-only and automatic");
    }
    return DrawHint::None;
}

DrawHint hintOf(const osg::NodePath& path)
{
    for (auto node = path.rbegin(); node != path.rend(); ++node)
    {
        const DrawHint hint = ownHint(**node);
        if (hint != DrawHint::None) return hint;
    }
    return DrawHint::None;
}

void setOwnHint(osg::Node& node, DrawHint hint)
{
    if (node.getUserDataContainer())
    {
        osg::Node::DescriptionList& descriptions = node.getDescriptions();
        descriptions.erase(std::remove_if(descriptions.begin(), descriptions.end(), isHint),
                           descriptions.end());
    }
    for (const HintWord& known : kWords)
        if (known.hint == hint) node.addDescription(std::string(kPrefix) + known.word);
}

} // namespace osgRayTrace::engine
