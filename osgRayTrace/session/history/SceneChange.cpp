// SceneChange.cpp - compares two versions of a scene part by part. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/SceneChange.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace osgRayTrace::engine
{

namespace
{

bool samePlace(const Affine& a, const Affine& b)
{
    return a.linear == b.linear && a.translation == b.translation;
}

/// Returns whether all that decides for the whole scene is the same.
bool sameWorld(const Scene& a, const Scene& b)
{
    const bool values = a.origin == b.origin && a.unit == b.unit && a.ambient == b.ambient &&
                        a.background == b.background && a.displayReferred == b.displayReferred;
    const bool air = a.atmosphere == b.atmosphere ||
                     (a.atmosphere && b.atmosphere && *a.atmosphere == *b.atmosphere);
    const bool volumes = std::equal(a.volumes.begin(), a.volumes.end(), b.volumes.begin(),
                                    b.volumes.end(), sameVolume);
    const bool media = air && volumes && a.fogUse == b.fogUse;
    if (hasGround(a.ground) || hasGround(b.ground)) return false; // no pixel knows its shadows
    const bool lights = std::equal(
        a.lights.begin(), a.lights.end(), b.lights.begin(), b.lights.end(),
        [](const Light& x, const Light& y) { return x.kind == y.kind && x.changed == y.changed; });
    const std::size_t textures = std::min(a.textures.size(), b.textures.size());
    return values && media && lights &&
           std::equal(a.textures.begin(), a.textures.begin() + static_cast<long>(textures),
                      b.textures.begin());
}

const Mesh* meshOf(const Scene& scene, const Instance& instance)
{
    return instance.mesh < scene.meshes.size() ? scene.meshes[instance.mesh].get() : nullptr;
}

bool sameMaterial(const Scene& before, const Scene& after, uint32_t material)
{
    return material < before.materials.size() && material < after.materials.size() &&
           before.materials[material].changed == after.materials[material].changed;
}

bool sameInstance(const Scene& before, const Scene& after, std::size_t i)
{
    if (i >= before.instances.size() || i >= after.instances.size()) return false;
    const Instance &a = before.instances[i], &b = after.instances[i];
    return meshOf(before, a) == meshOf(after, b) && a.placed == b.placed &&
           a.mirrored == b.mirrored && a.material == b.material && a.light == b.light &&
           samePlace(a.engineFromLocal, b.engineFromLocal) &&
           sameMaterial(before, after, a.material);
}

ChangedBox boundsOf(const Mesh& mesh)
{
    ChangedBox box;
    for (const Vec3& p : mesh.positions)
    {
        box.low = glm::min(box.low, p);
        box.high = glm::max(box.high, p);
    }
    return box;
}

bool isEmpty(const ChangedBox& box)
{
    return !(box.low.x <= box.high.x);
}

ChangedBox placed(const ChangedBox& local, const Affine& m)
{
    const Vec3 centre = transformPoint(m, 0.5f * (local.low + local.high));
    const Vec3 half = 0.5f * (local.high - local.low);
    Vec3 reach(0.0f);
    for (int axis = 0; axis < 3; ++axis)
        reach += glm::abs(m.linear[axis]) * half[axis];
    return {centre - reach, centre + reach};
}

float surfaceOf(const ChangedBox& box)
{
    const Vec3 d = box.high - box.low;
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

/// Bounds of meshes that many instances share, found once.
class MeshBounds
{
public:
    ChangedBox placedBounds(const Scene& scene, const Instance& instance)
    {
        const Mesh* mesh = meshOf(scene, instance);
        if (!mesh || mesh->triangles.empty()) return {};
        const auto [entry, isNew] = _boxes.try_emplace(mesh);
        if (isNew) entry->second = boundsOf(*mesh);
        if (isEmpty(entry->second) || !instance.placed) return entry->second;
        return placed(entry->second, instance.engineFromLocal);
    }

private:
    std::unordered_map<const Mesh*, ChangedBox> _boxes;
};

/// Adds the old and the new place: as one box if that is smaller, as for small steps.
void addPlaces(const ChangedBox& before, const ChangedBox& after, std::vector<ChangedBox>& boxes)
{
    const ChangedBox both{glm::min(before.low, after.low), glm::max(before.high, after.high)};
    if (!isEmpty(before) && !isEmpty(after) &&
        surfaceOf(both) <= surfaceOf(before) + surfaceOf(after))
    {
        boxes.push_back(both);
        return;
    }
    if (!isEmpty(before)) boxes.push_back(before);
    if (!isEmpty(after)) boxes.push_back(after);
}

Mat4d matrixOf(const Instance& instance)
{
    Mat4d matrix(1.0);
    if (!instance.placed) return matrix;
    for (int axis = 0; axis < 3; ++axis)
        matrix[axis] = Vec4d(Vec3d(instance.engineFromLocal.linear[axis]), 0.0);
    matrix[3] = Vec4d(Vec3d(instance.engineFromLocal.translation), 1.0);
    return matrix;
}

/// Returns whether a matrix turns and shifts, but for rounding.
bool isRigid(const Mat4d& matrix)
{
    constexpr double kTolerance = 1e-4;
    const glm::dmat3 linear(matrix);
    const glm::dmat3 product = glm::transpose(linear) * linear;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(product[column][row] - (column == row ? 1.0 : 0.0)) < kTolerance))
                return false;
    return glm::determinant(linear) > 0.0;
}

/// Returns how an instance has moved if nothing else of it has changed.
std::optional<RigidMove> rigidMove(const Scene& before, const Scene& after, uint32_t i)
{
    if (i >= before.instances.size() || i >= after.instances.size()) return std::nullopt;
    const Instance &a = before.instances[i], &b = after.instances[i];
    if (!meshOf(before, a) || meshOf(before, a) != meshOf(after, b) || a.mirrored != b.mirrored ||
        a.material != b.material || !sameMaterial(before, after, a.material))
        return std::nullopt;
    RigidMove move;
    move.instance = i;
    move.afterFromBefore = matrixOf(b) * glm::inverse(matrixOf(a));
    if (!isRigid(move.afterFromBefore)) return std::nullopt;
    return move;
}

bool emits(const Scene& scene, std::size_t i)
{
    return i < scene.instances.size() && scene.instances[i].light != kInvalid;
}

bool hasBounds(const ChangedBox& box)
{
    const Vec3 size = box.high - box.low;
    return std::isfinite(size.x + size.y + size.z);
}

} // namespace

ChangedBox instanceBounds(const Scene& scene, const Instance& instance)
{
    return MeshBounds().placedBounds(scene, instance);
}

std::optional<SceneChange> sceneChange(const Scene& before, const Scene& after)
{
    if (!sameWorld(before, after)) return std::nullopt;
    SceneChange change;
    const std::size_t count = std::max(before.instances.size(), after.instances.size());
    for (std::size_t i = 0; i < count; ++i)
    {
        if (sameInstance(before, after, i)) continue;
        if (emits(before, i) || emits(after, i) || change.instances.size() == kMostChanged)
            return std::nullopt;
        change.instances.push_back(static_cast<uint32_t>(i));
    }
    MeshBounds bounds;
    for (const uint32_t i : change.instances)
    {
        const auto placeIn = [&](const Scene& scene)
        {
            return i < scene.instances.size() ? bounds.placedBounds(scene, scene.instances[i])
                                              : ChangedBox();
        };
        const ChangedBox old = placeIn(before), now = placeIn(after);
        addPlaces(old, now, change.boxes);
        std::optional<RigidMove> move = rigidMove(before, after, i);
        if (!move || isEmpty(old) || isEmpty(now)) continue;
        move->before = old;
        move->after = now;
        change.moves.push_back(*move);
    }
    const bool finite = std::all_of(change.boxes.begin(), change.boxes.end(), hasBounds);
    return finite ? std::optional(std::move(change)) : std::nullopt;
}

} // namespace osgRayTrace::engine
