// ReferenceTracer.cpp - a path tracer that shares nothing with the integrators but surfaces and
// rays.
// SPDX-License-Identifier: MIT
#include "tests/statistics/ReferenceTracer.h"

#include "tests/Statistics.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/shading/LightTable.h"
#include "osgRayTrace/shading/MaterialTable.h"

namespace osgRayTrace::engine::test
{

namespace
{

struct SurfacePoint
{
    Vec3d position, normal, shading; ///< both normals are on the side of the incoming ray
    MaterialPoint on;
    uint32_t material = 0;
    uint32_t light = kInvalid;
    double clearance = 0.0; ///< distance at which rays leave the surface
};

struct Basis
{
    Vec3d x, y, z;

    explicit Basis(Vec3d normal) : z(normal)
    {
        x = glm::normalize(glm::cross(std::abs(z.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0), z));
        y = glm::cross(z, x);
    }
    Vec3 toLocal(Vec3d w) const { return Vec3(glm::dot(w, x), glm::dot(w, y), glm::dot(w, z)); }
    Vec3d toWorld(Vec3d w) const { return glm::normalize(x * w.x + y * w.y + z * w.z); }
};

SurfacePoint surfaceAt(const Scene& scene, const Hit& hit, Vec3d direction)
{
    const Instance& instance = scene.instances[hit.instance];
    const Mesh& mesh = *scene.meshes[instance.mesh];
    const UVec3 corner = mesh.triangles[hit.primitive];
    Vec3d p[3], n[3];
    for (int k = 0; k < 3; ++k)
    {
        const uint32_t index = corner[k];
        p[k] = Vec3d(mesh.positions[index]);
        if (!mesh.normals.empty()) n[k] = Vec3d(mesh.normals[index]);
        if (!instance.placed) continue;
        p[k] = glm::dmat3(instance.engineFromLocal.linear) * p[k] +
               Vec3d(instance.engineFromLocal.translation);
        n[k] = glm::transpose(glm::inverse(glm::dmat3(instance.engineFromLocal.linear))) * n[k];
    }
    const double u = hit.u, v = hit.v, w = 1.0 - u - v;
    SurfacePoint point;
    point.position = p[0] * w + p[1] * u + p[2] * v;
    point.normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
    if (instance.placed && instance.mirrored) point.normal = -point.normal;
    point.on.front = glm::dot(point.normal, direction) < 0.0;
    if (!point.on.front) point.normal = -point.normal;
    point.shading = point.normal;
    if (!mesh.normals.empty())
    {
        const Vec3d smooth = glm::normalize(n[0] * w + n[1] * u + n[2] * v);
        const Vec3d turned = glm::dot(smooth, point.normal) < 0.0 ? -smooth : smooth;
        if (glm::dot(turned, direction) < -1e-4) point.shading = turned;
    }
    if (!mesh.uvs.empty())
        point.on.uv =
            Vec2(Vec2(mesh.uvs[corner.x]) * float(w) + Vec2(mesh.uvs[corner.y]) * float(u) +
                 Vec2(mesh.uvs[corner.z]) * float(v));
    point.material = instance.material;
    point.light = instance.light;
    const Vec3d size = glm::abs(p[0]) + glm::abs(p[1]) + glm::abs(p[2]);
    point.clearance = 1e-6 * (size.x + size.y + size.z);
    return point;
}

class Tracer
{
public:
    Tracer(const TracedScene& traced, int maxBounces, uint32_t seed)
        : _traced(traced), _maxBounces(maxBounces), _random(seed)
    {
    }

    double uniform() { return double(_random()); }

    Vec3d radiance(Vec3d origin, Vec3d direction, float nearest)
    {
        Vec3d sum(0.0), beta(1.0);
        for (int bounce = 0;; ++bounce)
        {
            const auto hit = _traced.intersector().closestHit(Vec3(origin), Vec3(direction),
                                                              bounce ? 0.0f : nearest, kInfinity);
            if (!hit) return sum;
            const SurfacePoint point = surfaceAt(_traced.scene(), *hit, direction);
            sum += beta * emission(point);
            if (bounce == _maxBounces) return sum;
            const Basis basis(point.shading);
            const Vec3 wo = basis.toLocal(-glm::normalize(direction));
            const Bsdf bsdf = _traced.materials().bsdf(point.material, point.on);
            sum += beta * deltaLight(point, basis, bsdf, wo);
            if (!scatter(point, basis, bsdf, wo, beta, origin, direction)) return sum;
        }
    }

private:
    Vec3d emission(const SurfacePoint& point) const
    {
        if (point.light != kInvalid)
        {
            const Light& light = _traced.scene().lights[point.light];
            const bool dark = light.kind == LightKind::Parallelogram && !light.twoSided;
            if (dark && !point.on.front) return Vec3d(0.0);
        }
        return Vec3d(_traced.materials().emission(point.material, point.on));
    }

    Vec3d deltaLight(const SurfacePoint& point, const Basis& basis, const Bsdf& bsdf, Vec3 wo) const
    {
        Vec3d sum(0.0);
        for (const Light& light : _traced.scene().lights)
        {
            if (light.kind != LightKind::Point) continue;
            const Vec3d d = Vec3d(light.position) - point.position;
            const double distance = glm::length(d);
            const double side = glm::dot(d, point.normal) > 0.0 ? 1.0 : -1.0;
            const Vec3d from = point.position + point.normal * (side * point.clearance);
            const Vec3 wi = basis.toLocal(d / distance);
            const Vec3d fCos = value(bsdf, wo, wi);
            if ((wi.z > 0.0f) != (side > 0.0) || fCos == Vec3d(0.0)) continue;
            if (_traced.intersector().occluded(Vec3(from), Vec3(Vec3d(light.position) - from), 0.0f,
                                               1.0f))
                continue;
            const double falloff = light.attenuationConstant + light.attenuationLinear * distance +
                                   light.attenuationQuadratic * distance * distance;
            sum += fCos * Vec3d(light.diffuse) * (M_PI / falloff);
        }
        return sum;
    }

    /// Returns f cos; for a Lambert surface it is computed here.
    static Vec3d value(const Bsdf& bsdf, Vec3 wo, Vec3 wi)
    {
        if (bsdf.isDiffuse()) return Vec3d(bsdf.diffuse) * (std::max(double(wi.z), 0.0) / M_PI);
        return Vec3d(evalBsdf(bsdf, wo, wi).fCos);
    }

    bool scatter(const SurfacePoint& point, const Basis& basis, const Bsdf& bsdf, Vec3 wo,
                 Vec3d& beta, Vec3d& origin, Vec3d& direction)
    {
        const SpecularLobes lobes = specularLobes(bsdf, wo);
        const bool mirrors = lobes.reflection != Vec3(0.0f),
                   refracts = lobes.refraction != Vec3(0.0f);
        const int ways = 1 + mirrors + refracts;
        int way = std::min(int(uniform() * ways), ways - 1);
        if (way > 0 && !mirrors) ++way;
        Vec3d wi;
        if (way == 0)
        {
            const bool through = bsdf.transmits();
            const double z = through ? 2.0 * uniform() - 1.0 : uniform();
            const double phi = 2.0 * M_PI * uniform(), r = std::sqrt(1.0 - z * z);
            wi = Vec3d(r * std::cos(phi), r * std::sin(phi), z);
            beta *= value(bsdf, wo, Vec3(wi)) * (through ? 4.0 * M_PI : 2.0 * M_PI);
        }
        else
        {
            wi = way == 1 ? Vec3d(-wo.x, -wo.y, wo.z) : Vec3d(lobes.refracted);
            beta *= Vec3d(way == 1 ? lobes.reflection : lobes.refraction);
        }
        beta *= double(ways);
        direction = basis.toWorld(wi);
        const double side = glm::dot(direction, point.normal);
        // Light does not leak to the other side of the face, even if its normals are smooth.
        if ((side < 0.0) != (wi.z < 0.0) || beta == Vec3d(0.0)) return false;
        origin = point.position + point.normal * (side < 0.0 ? -point.clearance : point.clearance);
        return true;
    }

    const TracedScene& _traced;
    int _maxBounces;
    Uniform _random;
};

} // namespace

std::vector<double> tracePaths(const TracedScene& traced, const View& view, int maxBounces,
                               int pathsPerPixel, uint32_t seed)
{
    const std::optional<CameraRays> rays = cameraRays(view, traced.scene().origin);
    std::vector<double> image(3 * static_cast<std::size_t>(view.width * view.height), 0.0);
    if (!rays) return image;
    Workers().forEach(
        static_cast<std::size_t>(view.height),
        [&](std::size_t y)
        {
            Tracer tracer(traced, maxBounces, seed * 65537u + static_cast<uint32_t>(y));
            for (int x = 0; x < view.width; ++x)
            {
                Vec3d sum(0.0);
                for (int i = 0; i < pathsPerPixel; ++i)
                {
                    const double px = x + tracer.uniform(), py = double(y) + tracer.uniform();
                    const Vec3d origin = Vec3d(rays->origin) + px * Vec3d(rays->originDx) +
                                         py * Vec3d(rays->originDy);
                    const Vec3d direction = Vec3d(rays->direction) + px * Vec3d(rays->directionDx) +
                                            py * Vec3d(rays->directionDy);
                    sum += tracer.radiance(origin, direction, rays->nearS);
                }
                for (int c = 0; c < 3; ++c)
                    image[3 * (y * static_cast<std::size_t>(view.width) +
                               static_cast<std::size_t>(x)) +
                          static_cast<std::size_t>(c)] = sum[c] / pathsPerPixel;
            }
        });
    return image;
}

} // namespace osgRayTrace::engine::test
