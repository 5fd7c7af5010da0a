// PathBudget.h - ends traversals of graphs whose shared parts are on too many paths. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>

namespace osgRayTrace::engine
{

/// Largest number of groups and geometries that a conversion visits, each once for every path to
/// it. Forty groups with the next one twice below each have 2^40 paths: no traversal of them ends.
/// Real scenes have some hundred thousand paths. A million instances take a gigabyte.
constexpr std::size_t kMostPaths = std::size_t(1) << 22;

/// Counts the visits that are left for one traversal.
class PathBudget
{
public:
    explicit PathBudget(std::size_t most = kMostPaths) : _left(most) {}

    /// Takes one more visit. Returns false if no visit is left.
    bool take() { return _left > 0 && _left-- > 0; }

    std::size_t left() const { return _left; }

private:
    std::size_t _left;
};

/// Counts the visits that a traversal of all children would make below nodes. Each node is counted
/// once, in a time that is linear in nodes, however many paths there are.
class PathCounts
{
public:
    /// Returns the number of visits, including the node's own, but never more than most + 1. Levels
    /// below depth count as one.
    uint64_t of(osg::Node& node, uint64_t most, std::size_t depth)
    {
        const osg::Group* const group = node.asGroup();
        if (!group || depth == 0) return 1;
        const auto known = _counts.find(&node);
        if (known != _counts.end()) return std::min(known->second, most + 1);
        uint64_t count = 1;
        for (unsigned int i = 0; i < group->getNumChildren() && count <= most; ++i)
            if (osg::Node* const child = const_cast<osg::Node*>(group->getChild(i)))
                count += of(*child, most, depth - 1);
        count = std::min(count, most + 1);
        _counts.emplace(&node, count);
        return count;
    }

private:
    std::map<osg::ref_ptr<osg::Node>, uint64_t> _counts;
};

} // namespace osgRayTrace::engine
