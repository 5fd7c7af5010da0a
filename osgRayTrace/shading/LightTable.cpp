// LightTable.cpp - tables of a scene's lights, and samples of them. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LightTable.h"

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

/// Returns the index of the entry of a cumulative distribution that u in [0,1) falls into, and
/// rescales u within the entry.
std::size_t pick(const std::vector<float>& cumulative, float& u)
{
    const auto at = std::upper_bound(cumulative.begin(), cumulative.end() - 1, u);
    const auto index = static_cast<std::size_t>(at - cumulative.begin());
    const float low = index ? cumulative[index - 1] : 0.0f;
    const float width = cumulative[index] - low;
    u = width > 0.0f ? std::min((u - low) / width, kOneMinusEpsilon) : 0.0f;
    return index;
}

/// Returns running sums, computed in double and scaled to end at exactly 1; empty if all weights
/// are 0.
std::vector<float> cumulativeOf(const std::vector<double>& weights)
{
    double total = 0.0;
    for (const double w : weights)
        total += w;
    if (!(total > 0.0)) return {};
    std::vector<float> cumulative;
    cumulative.reserve(weights.size());
    double sum = 0.0;
    for (const double w : weights)
        cumulative.push_back(static_cast<float>((sum += w) / total));
    cumulative.back() = 1.0f;
    return cumulative;
}

/// A part of this many triangles is one piece of work.
constexpr std::size_t kTrianglesAtOnce = 4096;

/// Sets a triangle of a mesh, and returns its area.
double setTriangle(const Mesh& mesh, const SharedArray<Vec2>& uvs, const Instance& instance,
                   std::size_t number, EmissiveMesh::Triangle& triangle)
{
    const UVec3& t = mesh.triangles[number];
    Vec3 p[3] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    if (instance.placed)
        for (Vec3& q : p)
            q = transformPoint(instance.engineFromLocal, q);
    triangle.a = p[0];
    triangle.ab = p[1] - p[0];
    triangle.ac = p[2] - p[0];
    triangle.primitive = static_cast<uint32_t>(number);
    if (!uvs.empty())
    {
        triangle.ua = uvs[t.x];
        triangle.uab = uvs[t.y] - triangle.ua;
        triangle.uac = uvs[t.z] - triangle.ua;
    }
    const double area = 0.5 * glm::length(glm::cross(Vec3d(triangle.ab), Vec3d(triangle.ac)));
    triangle.area = static_cast<float>(area);
    return area;
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
            mesh = meshOf(scene, light, record, workers);
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

/// Makes the tree, or takes over its shape if the emitters are as many as before and have not moved
/// far apart.
void LightTable::plantTree(const LightTable* previous, const MaterialTable* materials,
                           const Workers* workers)
{
    constexpr double kMostSpread = 1.5; // times the spread for which the shape was made
    const LightEmitters emitters = lightEmitters(*_scene, *this, materials, workers);
    if (emitters.size() <= kMostWithoutTree) return;
    const LightTree* before = previous ? previous->_tree.get() : nullptr;
    if (before && before->holds(emitters))
        _tree = previous->_tree;
    else if (before && before->size() == emitters.size())
    {
        _tree = std::make_shared<const LightTree>(*before, emitters, workers);
        if (_tree->spread() > kMostSpread * _tree->spreadAtBuild())
            _tree = std::make_shared<const LightTree>(emitters, workers);
    }
    else
        _tree = std::make_shared<const LightTree>(emitters, workers);
    for (const uint32_t i : _deltaLights)
        if (!isInTree(_scene->lights[i])) _lightsBesideTree.push_back(i);
    findEmitters(workers);
}

/// Records the emitters of area lights, so that paths that meet a light find its probability.
void LightTable::findEmitters(const Workers* workers)
{
    std::size_t entries = 0;
    for (const uint32_t i : _areaLights)
    {
        Record& own = _records[_slots[i]];
        own.emitters = static_cast<uint32_t>(entries);
        const Light& light = _scene->lights[i];
        entries += light.kind == LightKind::Mesh
                       ? _scene->meshes[_scene->instances[light.instance].mesh]->triangles.size()
                       : 1;
    }
    _emitterOf.assign(entries, kInvalid);
    const auto setPart = [this](std::size_t begin, std::size_t end)
    {
        for (auto number = static_cast<uint32_t>(begin); number < end; ++number)
        {
            const LightEmitter& emitter = _tree->emitter(number);
            if (emitter.isPoint()) continue;
            const uint32_t triangle = emitter.flags & kTriangle ? emitter.primitive : 0;
            _emitterOf[record(emitter.light).emitters + triangle] = number;
        }
    };
    forEachPart(workers, _tree->size(), kTrianglesAtOnce, setPart);
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
    for (uint32_t number = 0; _tree && number < _tree->size(); ++number)
        add(_tree->emitter(number).light);
    for (uint32_t light = 0; light < _scene->lights.size(); ++light)
        add(light);
    return lights;
}

uint32_t LightTable::emitterOf(uint32_t light, uint32_t primitive) const
{
    const Record& own = record(light);
    if (!(own.area > 0.0f)) return kInvalid;
    return _emitterOf[own.emitters + (own.mesh == kInvalid ? 0 : primitive)];
}

EmissiveMesh LightTable::meshOf(const Scene& scene, const Light& light, Record& record,
                                const Workers* workers)
{
    const Instance& instance = scene.instances[light.instance];
    const Mesh& mesh = *scene.meshes[instance.mesh];
    const SharedArray<Vec2>& uvs =
        uvsOfSet(mesh, emissionUvSet(scene.materials[instance.material]));
    EmissiveMesh emissive;
    emissive.triangles.resize(mesh.triangles.size());
    std::vector<double> areas(mesh.triangles.size());
    forEachPart(workers, mesh.triangles.size(), kTrianglesAtOnce,
                [&](std::size_t begin, std::size_t end)
                {
                    for (std::size_t k = begin; k < end; ++k)
                        areas[k] = setTriangle(mesh, uvs, instance, k, emissive.triangles[k]);
                });
    std::size_t kept = 0;
    double total = 0.0;
    float largest = 0.0f;
    for (std::size_t k = 0; k < areas.size(); ++k)
    {
        if (!(areas[k] > 0.0)) continue;
        if (kept != k) emissive.triangles[kept] = emissive.triangles[k];
        const EmissiveMesh::Triangle& t = emissive.triangles[kept];
        largest = std::max(largest, sumAbs(t.a) + sumAbs(t.ab) + sumAbs(t.ac));
        total += areas[k];
        areas[kept++] = areas[k];
    }
    emissive.triangles.resize(kept);
    areas.resize(kept);
    emissive.cumulative = cumulativeOf(areas);
    record.area = static_cast<float>(total);
    record.offset = kLightOffsetScale * largest;
    return emissive;
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
    if (mesh.cumulative.empty()) return std::nullopt;
    const EmissiveMesh::Triangle& t = mesh.triangles[pick(mesh.cumulative, u)];
    // The sample is uniform on the triangle; folding the square along its diagonal keeps strata
    // together.
    if (u + v > 1.0f)
    {
        u = 1.0f - u;
        v = 1.0f - v;
    }
    const Vec3 normal(glm::normalize(glm::cross(Vec3d(t.ab), Vec3d(t.ac))));
    return LightPoint{t.a + u * t.ab + v * t.ac, normal, t.ua + u * t.uab + v * t.uac, from.offset};
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
