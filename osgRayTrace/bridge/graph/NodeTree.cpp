// NodeTree.cpp - stores paths that share their beginnings. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/NodeTree.h"

#include <osg/AutoTransform>
#include <osg/Billboard>
#include <osg/Camera>
#include <osg/Transform>

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

bool dependsOnView(osg::Node& node)
{
    if (node.asCamera() || dynamic_cast<const osg::Billboard*>(&node) ||
        dynamic_cast<const osg::AutoTransform*>(&node))
        return true;
    const osg::Transform* transform = node.asTransform();
    return transform && transform->getReferenceFrame() != osg::Transform::RELATIVE_RF;
}

} // namespace

uint32_t NodeTree::add(const osg::NodePath& path)
{
    constexpr std::size_t kAbove = 2;
    std::size_t shared = 0;
    while (shared < _last.size() && kAbove + shared < path.size() &&
           _entries[_last[shared]].node == path[kAbove + shared])
        ++shared;
    _last.resize(shared);
    for (std::size_t i = kAbove + shared; i < path.size(); ++i)
    {
        Entry entry;
        entry.node = path[i];
        const auto index = static_cast<uint32_t>(_entries.size());
        if (!_last.empty())
        {
            entry.parent = _last.back();
            entry.placedByView = _entries[entry.parent].placedByView;
        }
        if (entry.placedByView == kNone && dependsOnView(*path[i])) entry.placedByView = index;
        _entries.push_back(entry);
        _last.push_back(index);
    }
    return _last.empty() ? kNone : _last.back();
}

void NodeTree::way(uint32_t entry, std::vector<uint32_t>& entries) const
{
    entries.clear();
    for (; entry != kNone; entry = _entries[entry].parent)
        entries.push_back(entry);
    std::reverse(entries.begin(), entries.end());
}

} // namespace osgRayTrace::engine
