// PhotonTargets.cpp - spheres around what makes caustics. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonTargets.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

struct Box
{
    Vec3d low{std::numeric_limits<double>::infinity()};
    Vec3d high{-std::numeric_limits<double>::infinity()};

    void add(Vec3d p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    bool empty() const { return !(low.x <= high.x); }
};

Box boxOf(const Scene& scene, const Instance& instance)
{
    Box box;
    for (const Vec3& p : scene.meshes[instance.mesh]->positions)
        box.add(Vec3d(instance.placed ? transformPoint(instance.engineFromLocal, p) : p));
    return box;
}

/// Returns the smallest sphere around the box's centre that holds the box. It is too large for
/// balls, but a cone that is too wide only wastes photons.
Sphere sphereOf(const Box& box)
{
    const Vec3d half = (box.high - box.low) * 0.5;
    return {Vec3((box.low + box.high) * 0.5), static_cast<float>(glm::length(half) * 1.000001)};
}

/// Returns the sphere around the box's centre that holds the vertices: tight for balls.
Sphere tightSphere(const Scene& scene, const Instance& instance, const Box& box)
{
    const Vec3 centre((box.low + box.high) * 0.5);
    float radius2 = 0.0f;
    for (const Vec3& p : scene.meshes[instance.mesh]->positions)
    {
        const Vec3 q = (instance.placed ? transformPoint(instance.engineFromLocal, p) : p) - centre;
        radius2 = std::max(radius2, glm::dot(q, q));
    }
    return {centre, std::sqrt(radius2) * 1.00001f};
}

/// Returns whether photons that a surface sends on are caustics.
bool makesCaustics(const MaterialRecord& record, PhotonUse use)
{
    if (use == PhotonUse::Caustics && (record.front.isGlossy() || record.back.isGlossy()))
        return true;
    if (record.fixedFunction) return false; // highlights are never those of a mirror
    const auto bends = [&](const Bsdf& bsdf)
    {
        if (!bsdf.reflects() && !bsdf.transmits()) return false;
        // A texture may make parts of a surface smooth that is rough on average. Surfaces without
        // an interface transmit without bending, and count as targets, too.
        return !record.constant || bsdf.isSmooth() || (bsdf.transmits() && bsdf.eta == 1.0f);
    };
    return bends(record.front) || bends(record.back);
}

/// Groups spheres into at most limit of them: splits the list at the median of its longest axis
/// until each half may have one sphere.
void group(std::vector<Sphere> spheres, std::size_t limit, std::vector<Sphere>& groups)
{
    if (limit <= 1 || spheres.size() <= 1)
    {
        Box box;
        for (const Sphere& s : spheres)
        {
            box.add(Vec3d(s.centre) - Vec3d(s.radius));
            box.add(Vec3d(s.centre) + Vec3d(s.radius));
        }
        groups.push_back(spheres.size() == 1 ? spheres[0] : sphereOf(box));
        return;
    }
    Box box;
    for (const Sphere& s : spheres)
        box.add(Vec3d(s.centre));
    const Vec3d size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = spheres.size() / 2;
    std::nth_element(
        spheres.begin(), spheres.begin() + static_cast<std::ptrdiff_t>(half), spheres.end(),
        [axis](const Sphere& a, const Sphere& b) { return a.centre[axis] < b.centre[axis]; });
    group({spheres.begin(), spheres.begin() + static_cast<std::ptrdiff_t>(half)}, limit / 2,
          groups);
    group({spheres.begin() + static_cast<std::ptrdiff_t>(half), spheres.end()}, limit - limit / 2,
          groups);
}

} // namespace

PhotonTargets photonTargets(const TracedScene& traced, PhotonUse use, std::size_t most)
{
    const Scene& scene = traced.scene();
    Box all;
    std::vector<Sphere> single;
    for (const Instance& instance : scene.instances)
    {
        const Box box = boxOf(scene, instance);
        if (box.empty()) continue;
        all.add(box.low);
        all.add(box.high);
        const bool isBoundary =
            traced.traits().media && traced.media().isInterface(instance.material);
        if (!isBoundary && makesCaustics(traced.materials()[instance.material], use))
            single.push_back(tightSphere(scene, instance, box));
    }
    PhotonTargets targets;
    if (!all.empty()) targets.scene = sphereOf(all);
    if (!single.empty()) group(std::move(single), most, targets.spheres);
    return targets;
}

} // namespace osgRayTrace::engine
