// LightTable.cpp - tables of a scene's lights, and samples of them. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LightTable.h"

#include "osgRayTrace/shading/RunningShares.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

bool isArea(const Light& light)
{
    return light.kind == LightKind::Parallelogram || light.kind == LightKind::Mesh;
}

/// The inverse of this falloff is still a float.
constexpr float kLeastFalloff = 1e-37f;

/// Returns the length of any vector of floats: a light far from a small scene may be 1e21 engine
/// units away.
float lengthOf(Vec3 v)
{
    const float length2 = glm::dot(v, v);
    return length2 < 1e38f ? std::sqrt(length2) : static_cast<float>(glm::length(Vec3d(v)));
}

float sumAbs(Vec3 v)
{
    return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
}

/// Returns a point on a triangle, uniform by area. u, v in [0,1); offset: of the point.
LightPoint pointOn(const EmissiveMesh::Triangle& t, float u, float v, float offset)
{
    // Folding the square along its diagonal keeps strata together.
    if (u + v > 1.0f)
    {
        u = 1.0f - u;
        v = 1.0f - v;
    }
    const Vec3 normal(glm::normalize(glm::cross(Vec3d(t.ab), Vec3d(t.ac))));
    return {t.a + u * t.ab + v * t.ac, normal, t.ua + u * t.uab + v * t.uac, offset};
}

} // namespace

LightTable::Record LightTable::parallelogram(const Light& light)
{
    // The area is computed in double: the square of a small light's area is no normal float.
    const Vec3d perpendicular = glm::cross(Vec3d(light.edgeU), Vec3d(light.edgeV));
    Record record;
    record.area = static_cast<float>(glm::length(perpendicular));
    record.normal = Vec3(perpendicular / glm::length(perpendicular));
    record.offset =
        kLightOffsetScale * (sumAbs(light.corner) + sumAbs(light.edgeU) + sumAbs(light.edgeV));
    return record;
}

/// Builds the tables. Lights without power cost their slot and no more: a scene may hold millions.
LightTable::LightTable(const Scene& scene, const LightTable* previous,
                       const MaterialTable* materials, const Workers* workers)
    : _scene(&scene), _slots(scene.lights.size(), 0), _records(1)
{
    std::vector<double> powers;
    LocalAreas shared;
    if (previous)
        for (const PlacedLightTree& placed : previous->_placed)
            shared.emplace(placed.own->areas->mesh.get(), placed.own->areas);
    for (uint32_t i = 0; i < scene.lights.size(); ++i)
    {
        const Light& light = scene.lights[i];
        if (light.kind == LightKind::Environment)
        {
            // An environment without an image, which no converter makes, is no light.
            if (!_environment && light.environment.image)
                _environment = std::make_unique<PlacedEnvironment>(
                    light, i, previous ? previous->environment() : nullptr);
            continue;
        }
        if (!isArea(light))
        {
            // Black lights would each cost every surface point a look.
            const Vec3 sum = light.ambient + light.diffuse + light.specular;
            if (sum != Vec3(0.0f)) _deltaLights.push_back(i);
            continue;
        }
        if (!(luminance(light.radiance) > 0.0f)) continue;
        Record record;
        EmissiveMesh mesh;
        if (light.kind == LightKind::Parallelogram)
            record = parallelogram(light);
        else
        {
            mesh = meshOf(i, previous, shared, workers);
            record.area = static_cast<float>(mesh.area());
            record.offset = kLightOffsetScale * mesh.largest();
        }
        const double power = double(luminance(light.radiance)) * record.area *
                             (light.twoSided || light.kind == LightKind::Mesh ? 2.0 : 1.0);
        if (!(power > 0.0) || !std::isfinite(power)) continue;
        if (light.kind == LightKind::Mesh)
        {
            record.mesh = static_cast<uint32_t>(_meshes.size());
            _meshes.push_back(std::move(mesh));
        }
        else if (isRectangle(light.edgeU, light.edgeV))
        {
            record.rectangle = static_cast<uint32_t>(_rectangles.size());
            _rectangles.push_back(
                rectangleLight(plainOf(light.corner), plainOf(light.edgeU), plainOf(light.edgeV)));
        }
        _slots[i] = static_cast<uint32_t>(_records.size());
        _records.push_back(record);
        _areaLights.push_back(i);
        powers.push_back(power);
    }
    _cumulative = cumulativeOf(powers);
    for (std::size_t k = 0; k < _areaLights.size(); ++k)
        _records[k + 1].pmf = _cumulative[k] - (k ? _cumulative[k - 1] : 0.0f);
    plantTree(previous, materials, workers);
    std::vector<double> deltaPowers;
    for (const uint32_t i : lightsBesideTree())
        deltaPowers.push_back(double(sumAbs(scene.lights[i].ambient)) +
                              double(sumAbs(scene.lights[i].diffuse)) +
                              double(sumAbs(scene.lights[i].specular)));
    _deltaCumulative = cumulativeOf(deltaPowers);
}

/// Makes the trees, or takes over those of the last snapshot or their shapes.
void LightTable::plantTree(const LightTable* previous, const MaterialTable* materials,
                           const Workers* workers)
{
    plantMeshTrees(previous, materials, workers);
    SceneEmitters emitters = sceneEmitters(*_scene, *this, materials);
    if (!canBeNumbered(emitters.size)) return dropMeshTrees();
    if (emitters.size <= kMostWithoutTree && _placed.empty()) return;
    uint32_t index = 0;
    for (const uint32_t i : _areaLights)
    {
        Record& own = _records[_slots[i]];
        own.emitters = index;
        const bool triangles = own.mesh != kInvalid && own.placed == kInvalid;
        index += triangles ? static_cast<uint32_t>(_meshes[own.mesh].size()) : 1;
    }
    for (const uint32_t i : _deltaLights)
        if (!isInTree(_scene->lights[i])) _lightsBesideTree.push_back(i);
    const SceneLightTree* before = previous ? previous->_tree.get() : nullptr;
    if (before && before->holds(emitters, _placed))
    {
        _tree = previous->_tree;
        if (_tree->top()) _tree->top()->clearSpare();
        return;
    }
    const EmitterSource source = emitterSource(emitters, *_scene, *this);
    _tree = std::make_shared<const SceneLightTree>(emitters, source, _placed, before, workers);
}

/// Returns whether the numbers of all emitters have 32 bits: instances of a mesh share memory, but
/// no numbers. unplaced: the emitters that are not within a placed mesh.
bool LightTable::canBeNumbered(std::size_t unplaced) const
{
    uint64_t emitters = unplaced;
    for (const PlacedLightTree& placed : _placed)
        emitters += placed.own->tree->size();
    return emitters < kInvalid;
}

/// Leaves the lights without any tree: more than kMostWithoutTree are chosen by power,
/// and triangles by area.
void LightTable::dropMeshTrees()
{
    for (Record& record : _records)
        record.placed = kInvalid;
    _placed.clear();
}

std::vector<uint32_t> LightTable::lightsInSpace() const
{
    std::vector<uint32_t> lights;
    lights.reserve(_scene->lights.size());
    std::vector<bool> listed(_scene->lights.size(), false);
    const auto add = [&](uint32_t light)
    {
        if (!listed[light]) lights.push_back(light);
        listed[light] = true;
    };
    for (uint32_t leaf = 0; _tree && leaf < _tree->leaves(); ++leaf)
        add(_tree->leaf(leaf).light);
    for (uint32_t light = 0; light < _scene->lights.size(); ++light)
        add(light);
    return lights;
}

uint32_t LightTable::emitterOf(uint32_t light, uint32_t primitive) const
{
    const Record& own = record(light);
    if (!(own.area > 0.0f)) return kInvalid;
    if (own.placed != kInvalid) return _tree->numberOf(own.placed, primitive);
    if (own.mesh == kInvalid) return _tree->numberOfIndex(own.emitters);
    const uint32_t index = _meshes[own.mesh].areas->indexOf(primitive);
    return index == kInvalid ? kInvalid : _tree->numberOfIndex(own.emitters + index);
}

LightTable::Choice LightTable::chooseAreaLight(float u) const
{
    if (_areaLights.empty()) return {};
    if (_areaLights.size() == 1) return {_areaLights[0], 1.0f};
    const uint32_t light = _areaLights[pick(_cumulative, u)];
    return {light, areaLightPmf(light)};
}

LightTable::Choice LightTable::chooseDeltaLight(float u) const
{
    if (lightsBesideTree().empty()) return {};
    const std::size_t k = pick(_deltaCumulative, u);
    return {lightsBesideTree()[k], _deltaCumulative[k] - (k ? _deltaCumulative[k - 1] : 0.0f)};
}

std::optional<LightPoint> LightTable::samplePoint(uint32_t index, float u, float v) const
{
    const Light& light = _scene->lights[index];
    const Record& from = record(index);
    if (light.kind != LightKind::Mesh)
        return LightPoint{light.corner + u * light.edgeU + v * light.edgeV, from.normal, Vec2(u, v),
                          from.offset};

    if (from.mesh == kInvalid) return std::nullopt;
    const EmissiveMesh& mesh = _meshes[from.mesh];
    if (mesh.size() == 0) return std::nullopt;
    const std::size_t at = pick(mesh.areas->cumulative, u);
    return mesh.triangles.empty() ? pointOn(mesh.triangle(at), u, v, from.offset)
                                  : pointOn(mesh.triangles[at], u, v, from.offset);
}

std::optional<AreaLightSample> LightTable::sampleArea(uint32_t index, Vec3 p, float u,
                                                      float v) const
{
    const std::optional<LightPoint> point = samplePoint(index, u, v);
    if (!point) return std::nullopt;
    const Light& light = _scene->lights[index];
    return sampleAt(index, p, point->position, point->normal, point->uv,
                    light.twoSided || light.kind == LightKind::Mesh);
}

std::optional<AreaLightSample> LightTable::sampleAt(uint32_t index, Vec3 p, Vec3 q, Vec3 normal,
                                                    Vec2 uv, bool twoSided) const
{
    const Vec3 d = q - p;
    const float distance2 = glm::dot(d, d);
    if (!(distance2 > 0.0f)) return std::nullopt;
    AreaLightSample sample;
    sample.distance = std::sqrt(distance2);
    sample.wi = d / sample.distance;
    const float cosine = -glm::dot(sample.wi, normal);
    sample.cosThetaL = twoSided ? std::fabs(cosine) : cosine;
    if (!(sample.cosThetaL > 0.0f)) return std::nullopt;
    sample.uv = uv;
    sample.pdfW = pdfArea(index, sample.distance, sample.cosThetaL);
    sample.point = q;
    sample.normal = normal;
    sample.offset = record(index).offset;
    return sample;
}

float distanceTerm(const Light& light, float distance)
{
    const float falloff = light.attenuationConstant + light.attenuationLinear * distance +
                          light.attenuationQuadratic * distance * distance;
    if (!(falloff > kLeastFalloff)) return 0.0f;
    return light.range > 0.0f ? rangeTerm(light, distance) / falloff : 1.0f / falloff;
}

float spotTerm(const Light& light, Vec3 direction)
{
    if (light.spotCosCutoff <= -1.0f) return 1.0f;
    const float cosine = glm::dot(direction, light.direction);
    if (!(cosine >= light.spotCosCutoff && cosine > 0.0f)) return 0.0f;
    return std::pow(cosine, light.spotExponent);
}

DeltaLightSample sampleDelta(const Light& light, Vec3 p)
{
    DeltaLightSample sample;
    if (light.kind == LightKind::Directional)
    {
        sample.wi = -light.direction;
        sample.attenuation = 1.0f;
        return sample;
    }
    const Vec3 d = light.position - p;
    const float distance = lengthOf(d);
    if (!(distance > 0.0f)) return sample;
    sample.distance = distance;
    sample.wi = d / distance;
    sample.attenuation = distanceTerm(light, distance) * spotTerm(light, -sample.wi);
    return sample;
}

} // namespace osgRayTrace::engine
