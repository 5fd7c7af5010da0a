// SeenColors.cpp - colours by material: constant, of vertices, of one texture, or of a Bsdf. Layer:
// integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/SeenColors.h"

#include "osgRayTrace/accel/SurfaceAttributes.h"
#include "osgRayTrace/integrators/shared/FogLanes.h"
#include "osgRayTrace/shading/TextureLanes.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Holds a value at each vertex of the lanes' triangles.
struct Corners
{
    Vec3Lanes a, b, c;
};

OSGRAYTRACE_KERNEL
void interpolateCorners(const RayHitBlock& rays, const Corners& corners, Vec3Lanes& values)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float u = rays.u[i], v = rays.v[i], w = 1.0f - u - v;
        values.x[i] = corners.a.x[i] * w + corners.b.x[i] * u + corners.c.x[i] * v;
        values.y[i] = corners.a.y[i] * w + corners.b.y[i] * u + corners.c.y[i] * v;
        values.z[i] = corners.a.z[i] * w + corners.b.z[i] * u + corners.c.z[i] * v;
    }
}

/// Interpolates the values of an instance's vertices in the lanes; value(vertex) returns a Vec3.
template <class ValueOf>
void interpolate(const SurfaceRecord& record, const RayHitBlock& rays, LaneMask lanes,
                 const ValueOf& value, Vec3Lanes& values)
{
    Corners corners{}; // lanes that are not used are computed, too
    uint32_t known = kInvalid;
    Vec3 a(0.0f), b(0.0f), c(0.0f);
    for (const int i : lanesIn(lanes))
    {
        if (rays.primitive[i] != known)
        {
            known = rays.primitive[i];
            const UVec3 t = record.triangles[known];
            a = value(t.x);
            b = value(t.y);
            c = value(t.z);
        }
        setLane(corners.a, i, a);
        setLane(corners.b, i, b);
        setLane(corners.c, i, c);
    }
    interpolateCorners(rays, corners, values);
}

/// Tells how the colour of most materials is made: factor, or the vertex colour, times the texture.
struct ColorSource
{
    bool known = false; ///< false: the colour is made otherwise
    Vec3 factor{1.0f};
    bool atVertices = false; ///< the vertex colour takes the place of factor
    bool replaced = false;   ///< the texture takes the place of all others
    const Texture* texture = nullptr;
};

bool isPlain(const TextureMapping& mapping)
{
    return mapping.coordinates == TextureCoordinates::Uv0 && !mapping.transformed &&
           !mapping.partly;
}

ColorSource colorSourceOf(const Scene& scene, const Material& m)
{
    ColorSource source;
    if (m.baseColorTexture != kInvalid) source.texture = scene.textures[m.baseColorTexture].get();
    if (m.hasBack || m.emission != Vec3(0.0f) || m.second.texture != kInvalid) return source;
    if (source.texture && (!isPlain(m.mapping) || source.texture->cube ||
                           source.texture->depth > 0 || !source.texture->hasColor))
        return source;
    if (m.model == MaterialModel::Physical)
    {
        // Base, metal and glass share the base colour, whatever their shares are.
        source.factor = m.baseColor;
        source.known = !m.detail;
        return source;
    }
    const VertexColorUse use = m.vertexColorUse;
    const bool plain = !m.lit || (m.specular == Vec3(0.0f) && use != VertexColorUse::Specular &&
                                  use != VertexColorUse::Emission);
    source.factor = m.diffuse;
    source.atVertices =
        m.lit ? use == VertexColorUse::Diffuse || use == VertexColorUse::AmbientAndDiffuse
              : use != VertexColorUse::None;
    source.replaced = source.texture && m.textureEnvironment == TextureEnvironment::Replace;
    source.known = plain && (!source.texture || source.replaced ||
                             m.textureEnvironment == TextureEnvironment::Modulate);
    return source;
}

/// Multiplies the colours by a texture's, or by 1 if there is none, and keeps them in [0,1].
OSGRAYTRACE_KERNEL
void finishColors(const Vec3Lanes& texels, bool textured, Vec3Lanes& colors)
{
    const uint32_t uses = maskOf(textured);
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float r = colors.x[i] * select(uses, texels.x[i], 1.0f),
                    g = colors.y[i] * select(uses, texels.y[i], 1.0f),
                    b = colors.z[i] * select(uses, texels.z[i], 1.0f);
        const float r0 = select(r > 0.0f, r, 0.0f), g0 = select(g > 0.0f, g, 0.0f),
                    b0 = select(b > 0.0f, b, 0.0f);
        colors.x[i] = select(r0 < 1.0f, r0, 1.0f);
        colors.y[i] = select(g0 < 1.0f, g0, 1.0f);
        colors.z[i] = select(b0 < 1.0f, b0, 1.0f);
    }
}

/// Sets the widths of the lanes' footprints in the texture coordinates of unit 0.
void textureWidths(const SurfaceRecord& record, const RayHitBlock& rays,
                   const SurfaceLanes& surface, LaneMask lanes, FloatLanes& widths)
{
    uint32_t known = kInvalid;
    float scale = 0.0f;
    for (const int i : lanesIn(lanes))
    {
        if (rays.primitive[i] != known)
        {
            known = rays.primitive[i];
            scale = textureScale(record, record.uvs, known);
        }
        widths[i] = scale * surface.footprint[i];
    }
}

/// Sets the texture's colours in the lanes, which hit one instance.
void texelColors(const SurfaceRecord& record, const Texture& texture, const RayHitBlock& rays,
                 const SurfaceLanes& surface, LaneMask lanes, Vec3Lanes& texels)
{
    Vec3Lanes uv;
    const Vec2* uvs = record.uvs;
    interpolate(
        record, rays, lanes, [&](uint32_t k) { return uvs ? Vec3(uvs[k], 0.0f) : Vec3(0.0f); }, uv);
    if (texture.mips.empty() || (lanes & ~surface.coned))
    {
        textureColors(texture, uv.x, uv.y, lanes, texels);
        return;
    }
    FloatLanes widths;
    textureWidths(record, rays, surface, lanes, widths);
    textureColors(texture, uv.x, uv.y, widths, lanes, texels);
}

/// Returns the colours of the lanes, which hit one instance.
void sourceColors(const SurfaceRecord& record, const ColorSource& source, const RayHitBlock& rays,
                  const SurfaceLanes& surface, LaneMask lanes, Vec3Lanes& colors)
{
    if (source.atVertices && record.colors && !source.replaced)
        interpolate(
            record, rays, lanes, [&](uint32_t k) { return Vec3(record.colors[k]); }, colors);
    else
    {
        const Vec3 factor = source.replaced || source.atVertices ? Vec3(1.0f) : source.factor;
        for (const int i : lanesIn(lanes))
            setLane(colors, i, factor);
    }
    Vec3Lanes texels;
    if (source.texture) texelColors(record, *source.texture, rays, surface, lanes, texels);
    finishColors(texels, source.texture != nullptr, colors);
}

/// Returns the active lanes that hit the instance of the first of them.
OSGRAYTRACE_KERNEL
LaneMask onInstance(const UintLanes& instance, LaneMask active, int first)
{
    const uint32_t wanted = instance[first];
    LaneMask same = 0;
    OSGRAYTRACE_SIMD_OR(same)
    for (int i = 0; i < kLanes; ++i)
        same |= bitOfLane(maskOf(instance[i] == wanted), i);
    return same & active;
}

/// Returns linearFromSrgb within 0.002 for [0,1]. The approximation is cheaper, and it runs for
/// each pixel of each frame.
OSGRAYTRACE_INLINE float nearlyLinear(float encoded)
{
    return encoded * (encoded * (encoded * 0.305306f + 0.682171f) + 0.012523f);
}

OSGRAYTRACE_KERNEL
void decodeColors(Vec3Lanes& colors)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        colors.x[i] = nearlyLinear(colors.x[i]);
        colors.y[i] = nearlyLinear(colors.y[i]);
        colors.z[i] = nearlyLinear(colors.z[i]);
    }
}

/// Sets the colours of lanes that hit one instance.
void instanceColors(const PassContext& context, const RayHitBlock& rays,
                    const SurfaceLanes& surface, LaneMask lanes, Vec3Lanes& colors)
{
    const MaterialTable& materials = context.traced->materials();
    const int first = firstLane(lanes);
    const uint32_t material = surface.material[first];
    const MaterialRecord& record = materials[material];
    const ColorSource source = colorSourceOf(context.traced->scene(), *record.material);
    if (record.constant && !record.emits)
    {
        const Vec3 albedo = bsdfAlbedo(record.front);
        for (const int i : lanesIn(lanes))
            setLane(colors, i, albedo);
    }
    else if (source.known)
    {
        Vec3Lanes own;
        sourceColors(context.traced->surfaces()[surface.instance[first]], source, rays, surface,
                     lanes, own);
        for (const int i : lanesIn(lanes))
            setLane(colors, i, plainOf(own, i));
    }
    else
        for (const int i : lanesIn(lanes))
        {
            const Vec3 albedo =
                bsdfAlbedo(materials.bsdf(material, materialPoint(context, rays, surface, i)));
            setLane(colors, i, albedo + emissionTowardsRay(context, rays, surface, i));
        }
}

/// Mixes the fog's colour into the colours of what the eye sees.
void addFog(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface,
            Vec3Lanes& colors)
{
    FloatLanes depths;
    FogLanes fog;
    fogOf(context, {rays, surface, kAllLanes, 0}, depths, fog);
    for (const int i : lanesIn(fog.lanes))
        setLane(colors, i, laneOf(colors, i) * fog.share[i] + laneOf(fog.added, i));
}

} // namespace

void seenColors(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface,
                Vec3Lanes& colors)
{
    for (FloatLanes* channel : {&colors.x, &colors.y, &colors.z})
        std::fill_n(channel->v, kLanes, 0.0f);
    for (LaneMask left = surface.hits; left;)
    {
        const LaneMask lanes = onInstance(surface.instance, left, firstLane(left));
        instanceColors(context, rays, surface, lanes, colors);
        left &= ~lanes;
    }
    if (context.traced->traits().fog) addFog(context, rays, surface, colors);
    if (context.traced->scene().displayReferred) decodeColors(colors);
}

} // namespace osgRayTrace::engine
