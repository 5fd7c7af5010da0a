// CullOutcome.cpp - tells which nodes may draw in cull alone. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/CullOutcome.h"

#include "osgRayTrace/bridge/common/NodeKind.h"
#include "osgRayTrace/bridge/graph/DrawHint.h"

#include <osgRayTrace/RayTracedScene>

#include <osg/Callback>
#include <osg/Group>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <typeinfo>

namespace osgRayTrace::engine
{

namespace
{

constexpr std::array<std::string_view, 17> kKnownLibraries = {
    "osg",         "osgAnimation", "osgDB",     "osgFX",     "osgGA",      "osgManipulator",
    "osgParticle", "osgRayTrace",  "osgShadow", "osgSim",    "osgTerrain", "osgText",
    "osgUI",       "osgUtil",      "osgViewer", "osgVolume", "osgWidget"};

/// Returns the outermost namespace of a class, or nothing for a class of no namespace.
/// libraryName() is that of a base class if a class does not say its own. GCC and Clang write
/// "N3osg5GroupE".
std::string_view outerNamespace(const std::type_info& type)
{
    const std::string_view name = type.name();
    if (name.empty() || name[0] != 'N') return {};
    std::size_t at = 1, length = 0;
    for (; at < name.size() && name[at] >= '0' && name[at] <= '9'; ++at)
        length = 10 * length + static_cast<std::size_t>(name[at] - '0');
    return name.substr(std::min(at, name.size()), length);
}

bool isOfKnownLibrary(const std::type_info& type)
{
    const std::string_view library = outerNamespace(type);
    return std::find(kKnownLibraries.begin(), kKnownLibraries.end(), library) !=
           kKnownLibraries.end();
}

/// Returns whether a chain of callbacks has one that is not OSG's: OSG's own cull callbacks only
/// hide things from views.
bool hasForeign(const osg::Callback* callback)
{
    for (; callback; callback = callback->getNestedCallback())
        if (!isOfKnownLibrary(typeid(*callback))) return true;
    return false;
}

bool isHintedAlike(const osg::Node& node, std::set<const osg::Node*>& seen)
{
    const osg::Group* group = node.asGroup();
    if (!group || !seen.insert(group).second) return true;
    for (const osg::ref_ptr<osg::Node>& child : childrenOf(*group))
    {
        if (!child) continue;
        const DrawHint hint = ownHint(*child);
        if (hint == DrawHint::Trace || hint == DrawHint::Automatic) return false;
        if (!isHintedAlike(*child, seen)) return false;
    }
    return true;
}

} // namespace

bool CullOutcome::isDrawn() const
{
    return kind == Left || otherStages ||
           std::any_of(leaves.begin(), leaves.end(),
                       [](const CulledLeaf& leaf) { return leaf.left != nullptr; });
}

const char* cullReason(const osg::Node& node)
{
    const bool calls = node.getCullCallback() && hasForeign(node.getCullCallback());
    if (!calls && (kindOf(node) != NodeKind::Untracked || isOfKnownLibrary(typeid(node))))
        return nullptr;
    if (dynamic_cast<const RayTracedScene*>(&node)) return nullptr; // a plain group for conversions
    return calls ? "rasterized.cull-callback" : "rasterized.foreign-node";
}

bool isHintedAlike(const osg::Node& node)
{
    std::set<const osg::Node*> seen;
    return isHintedAlike(node, seen);
}

} // namespace osgRayTrace::engine
