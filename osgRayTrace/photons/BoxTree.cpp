// BoxTree.cpp - sorts items and puts boxes over them. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/BoxTree.h"

#include <algorithm>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Spreads ten bits so that two bits lie between any two of them.
uint32_t spread(uint32_t v)
{
    v = (v * 0x00010001u) & 0xff0000ffu;
    v = (v * 0x00000101u) & 0x0f00f00fu;
    v = (v * 0x00000011u) & 0xc30c30c3u;
    return (v * 0x00000005u) & 0x49249249u;
}

void add(ItemBox& box, const ItemBox& other)
{
    box.low = glm::min(box.low, other.low);
    box.high = glm::max(box.high, other.high);
}

/// Returns the boxes over groups of sixteen boxes.
std::vector<ItemBox> joined(const std::vector<ItemBox>& boxes)
{
    std::vector<ItemBox> groups((boxes.size() + kLanes - 1) / kLanes);
    for (std::size_t k = 0; k < boxes.size(); ++k)
        add(groups[k / kLanes], boxes[k]);
    return groups;
}

std::vector<BoxTree::Node> nodesOver(const std::vector<ItemBox>& boxes)
{
    std::vector<BoxTree::Node> nodes((boxes.size() + kLanes - 1) / kLanes);
    for (std::size_t k = 0; k < nodes.size() * kLanes; ++k)
    {
        const bool used = k < boxes.size();
        const Vec3 low = used ? boxes[k].low : Vec3(0.0f), high = used ? boxes[k].high : Vec3(0.0f);
        BoxTree::Node& node = nodes[k / kLanes];
        const auto lane = static_cast<int>(k % kLanes);
        setLane(node.centre, lane, 0.5f * (low + high));
        node.radius[lane] = used ? 0.5f * glm::length(high - low) * 1.0001f : -kInfinity;
    }
    return nodes;
}

} // namespace

BoxTree::BoxTree(const std::vector<ItemBox>& boxes, std::vector<uint32_t>& order)
    : _size(boxes.size())
{
    order.resize(boxes.size());
    if (boxes.empty()) return;
    ItemBox all;
    for (const ItemBox& box : boxes)
        add(all, box);
    const Vec3 size = glm::max(all.high - all.low, Vec3(1e-30f));
    const float scale = 1023.0f / std::max(size.x, std::max(size.y, size.z));
    std::vector<std::pair<uint32_t, uint32_t>> keys(boxes.size());
    for (std::size_t k = 0; k < boxes.size(); ++k)
    {
        const Vec3 at = (0.5f * (boxes[k].low + boxes[k].high) - all.low) * scale;
        const auto cell = [](float v)
        { return spread(static_cast<uint32_t>(std::clamp(v, 0.0f, 1023.0f))); };
        keys[k] = {cell(at.x) | cell(at.y) << 1 | cell(at.z) << 2, static_cast<uint32_t>(k)};
    }
    std::sort(keys.begin(), keys.end());
    std::vector<ItemBox> sorted(boxes.size());
    for (std::size_t k = 0; k < boxes.size(); ++k)
    {
        order[k] = keys[k].second;
        sorted[k] = boxes[order[k]];
    }
    do
    {
        sorted = joined(sorted);
        _levels.push_back(nodesOver(sorted));
    } while (_levels.back().size() > 1);
}

std::size_t BoxTree::bytes() const
{
    std::size_t sum = 0;
    for (const std::vector<Node>& level : _levels)
        sum += level.size() * sizeof(Node);
    return sum;
}

} // namespace osgRayTrace::engine
