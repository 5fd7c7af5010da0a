// SceneLightTree.cpp - choices and probabilities through both levels of a light tree. Layer:
// shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/SceneLightTree.h"

#include <algorithm>

namespace osgRayTrace::engine
{

SceneLightTree::SceneLightTree(SceneEmitters emitters, const EmitterSource& source,
                               std::vector<PlacedLightTree> placed, const SceneLightTree* previous,
                               const Workers* workers)
    : _emitters(std::move(emitters)),
      _placed(std::move(placed)),
      _leaves(_emitters.size),
      _size(_emitters.size)
{
    OSGRAYTRACE_ASSERT(_leaves > 0);
    constexpr uint32_t kFirst = 0;
    if (_leaves > 1)
        _top =
            LightTree::after(previous ? previous->_top.get() : nullptr, source, _leaves, workers);
    else
        source(&kFirst, 1, &_only);
    if (_placed.empty()) return;

    _placedOf.assign(_leaves, kInvalid);
    OSGRAYTRACE_ASSERT(_emitters.meshes.size() == _placed.size());
    for (const std::size_t index : _emitters.meshes)
    {
        const uint32_t leaf = _top ? _top->numberOf(index) : 0;
        _placedOf[leaf] = static_cast<uint32_t>(_leafOf.size());
        _leafOf.push_back(leaf);
    }
    _size = 0;
    for (const uint32_t k : _placedOf)
    {
        _first.push_back(static_cast<uint32_t>(_size));
        _size += k == kInvalid ? 1 : _placed[k].own->tree->size();
    }
}

uint32_t SceneLightTree::leafOfNumber(uint32_t number) const
{
    const auto after = std::upper_bound(_first.begin(), _first.end(), number);
    return static_cast<uint32_t>(after - _first.begin()) - 1;
}

LightEmitter SceneLightTree::placedEmitter(uint32_t number) const
{
    const uint32_t at = leafOfNumber(number), k = _placedOf[at];
    return k == kInvalid ? leaf(at) : _placed[k].emitter(number - _first[at]);
}

void SceneLightTree::gather(const UintLanes& numbers, Gathered& gathered) const
{
    if (_placed.empty())
    {
        gathered.emitters = _top->emitters();
        gathered.at = numbers;
        return;
    }
    gathered.emitters = gathered.held;
    for (int i = 0; i < kLanes; ++i)
    {
        gathered.held[i] = placedEmitter(numbers[i]);
        gathered.at[i] = static_cast<uint32_t>(i);
    }
}

SceneLightTree::Choice SceneLightTree::choose(Vec3 p, Vec3 normal, float u) const
{
    Choice choice{0, 1.0f};
    if (_top) choice = _top->choose(p, normal, u);
    if (_placed.empty()) return choice;
    const uint32_t leaf = choice.emitter, k = _placedOf[leaf];
    choice.emitter = _first[leaf];
    if (k == kInvalid) return choice;
    const PlacedLightTree& placed = _placed[k];
    const Choice below = placed.own->tree->choose(transformPoint(placed.localFromEngine, p),
                                                  placed.localFromNormal * normal, u);
    return {choice.emitter + below.emitter, choice.pmf * below.pmf};
}

float SceneLightTree::placedPmf(Vec3 p, Vec3 normal, uint32_t number) const
{
    const uint32_t leaf = leafOfNumber(number), k = _placedOf[leaf];
    const float pmf = _top ? _top->pmf(p, normal, leaf) : 1.0f;
    if (k == kInvalid) return pmf;
    const PlacedLightTree& placed = _placed[k];
    return pmf * placed.own->tree->pmf(transformPoint(placed.localFromEngine, p),
                                       placed.localFromNormal * normal, number - _first[leaf]);
}

namespace
{

struct Lanes3
{
    Vec3Lanes p, normal;
};

/// Returns surface points in the space of a mesh.
Lanes3 pointsFrom(const PlacedLightTree& placed, const Vec3Lanes& p, const Vec3Lanes& normal)
{
    Lanes3 local;
    for (int i = 0; i < kLanes; ++i)
    {
        setLane(local.p, i, transformPoint(placed.localFromEngine, laneOf(p, i)));
        setLane(local.normal, i, placed.localFromNormal * laneOf(normal, i));
    }
    return local;
}

} // namespace

void SceneLightTree::chooseLanes(const Vec3Lanes& p, const Vec3Lanes& normal, Pick* picks,
                                 std::size_t count) const
{
    if (_top)
        _top->chooseLanes(p, normal, picks, count);
    else
        for (std::size_t k = 0; k < count; ++k)
            for (int i = 0; i < kLanes; ++i)
            {
                picks[k].emitters[i] = 0;
                picks[k].pmf[i] = 1.0f;
            }
    if (_placed.empty()) return;
    for (std::size_t k = 0; k < count; ++k)
        choosePlaced(p, normal, picks[k]);
}

/// Takes the lanes that have chosen a mesh with a tree of its own down that tree.
void SceneLightTree::choosePlaced(const Vec3Lanes& p, const Vec3Lanes& normal, Pick& pick) const
{
    const UintLanes leaves = pick.emitters;
    LaneMask open = 0;
    for (int i = 0; i < kLanes; ++i)
    {
        pick.emitters[i] = _first[leaves[i]];
        open |= static_cast<LaneMask>(_placedOf[leaves[i]] != kInvalid) << i;
    }
    // Lanes that have come to the same mesh descend together.
    while (open)
    {
        const uint32_t leaf = leaves[firstLane(open)];
        LaneMask same = 0;
        for (const int i : lanesIn(open))
            same |= static_cast<LaneMask>(leaves[i] == leaf) << i;
        const PlacedLightTree& placed = _placed[_placedOf[leaf]];
        const Lanes3 local = pointsFrom(placed, p, normal);
        Pick below;
        below.u = pick.u;
        placed.own->tree->chooseLanes(local.p, local.normal, &below, 1);
        for (const int i : lanesIn(same))
        {
            pick.emitters[i] += below.emitters[i];
            pick.pmf[i] *= below.pmf[i];
        }
        open &= ~same;
    }
}

} // namespace osgRayTrace::engine
