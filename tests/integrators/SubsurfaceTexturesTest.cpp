// SubsurfaceTexturesTest.cpp - bodies below diffuse boundaries whose values textures decide on.
// SPDX-License-Identifier: MIT
//
// All tests have fixed seeds. Means have to agree within four standard errors, as Estimate says.
#include "osgRayTrace/shading/TextureSample.h"
#include "tests/integrators/MaterialDetails.h"
#include "tests/integrators/SubsurfaceScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a texture of a row of texels, each of which is nearest over its share of s.
std::shared_ptr<const Texture> rowOf(const std::vector<Vec4>& texels)
{
    auto texture = std::make_shared<Texture>();
    texture->width = static_cast<int>(texels.size());
    texture->height = 1;
    texture->linearFilter = false;
    texture->wrapS = TextureWrap::ClampToEdge;
    for (const Vec4& t : texels)
        texture->floats.insert(texture->floats.end(), {t.x, t.y, t.z, t.w});
    return texture;
}

/// Gives a mesh texture coordinates (s, 0.5), s from 0 to 1 along an axis of its box.
std::shared_ptr<Mesh> mappedAlong(const std::shared_ptr<Mesh>& mesh, int axis)
{
    float least = kInfinity, most = -kInfinity;
    for (const Vec3& p : mesh->positions)
    {
        least = std::min(least, p[axis]);
        most = std::max(most, p[axis]);
    }
    std::vector<Vec2> uvs;
    for (const Vec3& p : mesh->positions)
        uvs.emplace_back((p[axis] - least) / (most - least), 0.5f);
    mesh->uvs = std::move(uvs);
    return mesh;
}

enum Field
{
    kColor,
    kWeight,
    kRadius,
    kMetal,
};

/// Has texture 0 of a scene decide on one value of wax.
Material textured(const Material& material, Field field)
{
    Material result = material;
    MaterialDetail detail = *material.detail;
    if (field == kColor) result.baseColorTexture = 0;
    if (field == kWeight) detail.textures[kSubsurfaceRole] = 0;
    if (field == kMetal)
    {
        result.metallicRoughnessTexture = 0;
        if (result.metallic == 0.0f) result.metallic = 1.0f;
    }
    if (field == kRadius) detail.textures[kSubsurfaceRadiusRole] = 0;
    return withDetail(result, detail);
}

/// A wide block whose upper face is z = 0, in a white sky: nearly a half-space in the middle of
/// each half.
std::shared_ptr<const TracedScene> blockOf(const Material& material,
                                           const std::shared_ptr<const Texture>& texture)
{
    SceneBuilder builder;
    builder.add(mappedAlong(boxMesh(Vec3(-40.0f, -40.0f, -40.0f), Vec3(40.0f, 40.0f, 0.0f)), 0),
                material);
    if (texture) builder.scene->textures.push_back(texture);
    addSky(builder);
    return builder.build();
}

Estimate patchAt(const std::shared_ptr<const TracedScene>& traced, double x, int passes)
{
    return measure(traced, patchView({x, 0, 0}, {0, 0, 1}, 1.0, 32),
                   optionsOf(IntegratorKind::Path, 8), passes);
}

/// A wall of wax before a lamp, and the floor before the wall. axis: along which its texels differ,
/// 1: its halves before and behind.
std::shared_ptr<const TracedScene> wallOf(const Material& material,
                                          const std::shared_ptr<const Texture>& texture, int axis)
{
    SceneBuilder builder;
    builder.add(mappedAlong(boxMesh(Vec3(-6.0f, 0.0f, -0.5f), Vec3(6.0f, 0.3f, 8.0f)), axis),
                material);
    builder.scene->textures.push_back(texture);
    builder.add(quadMesh({-6.0f, -6.0f, 0.0f}, {12.0f, 0.0f, 0.0f}, {0.0f, 6.0f, 0.0f}),
                lambert(Vec3(0.6f)));
    builder.addQuadLight({-0.5f, 1.0f, 0.5f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, Vec3(30.0f));
    return builder.build();
}

} // namespace

TEST_CASE("subsurface textures: a constant texture is the constant", "[subsurface]")
{
    const Vec3 color(0.8f, 0.5f, 0.25f), radius(0.5f, 0.25f, 0.125f);
    const auto waxOf = [](Vec3 ofColor, Vec3 ofRadius, float weight)
    {
        Material material = wax(ofColor, ofRadius, 1.4f, weight);
        material.metallic = 0.25f;
        return material;
    };
    const Material plain = waxOf(color, radius, 0.75f);
    const RenderOptions options = optionsOf(IntegratorKind::Path, 5);
    const Picture expected = render(blockOf(plain, nullptr), roomView(), options, 2);
    const struct
    {
        Field field;
        Material material;
        Vec4 value;
    } cases[] = {{kColor, waxOf(Vec3(1.0f), radius, 0.75f), Vec4(color, 1.0f)},
                 {kWeight, waxOf(color, radius, 1.0f), Vec4(0.75f, 0.1f, 0.2f, 0.3f)},
                 {kRadius, waxOf(color, Vec3(1.0f), 0.75f), Vec4(radius, 0.5f)},
                 {kMetal, plain, Vec4(0.3f, 1.0f, 1.0f, 0.5f)}};
    for (const auto& c : cases)
    {
        const auto texture = rowOf({c.value});
        const Picture seen =
            render(blockOf(textured(c.material, c.field), texture), roomView(), options, 2);
        CAPTURE(int(c.field));
        CHECK(seen.progress.collisions > 0);
        CHECK(seen.rgba == expected.rgba);
    }
}

TEST_CASE("subsurface textures: a white body is not seen in a white sky, whatever its textures",
          "[statistics][subsurface]")
{
    const auto texture = rowOf(
        {Vec4(1.0f), Vec4(0.2f, 0.7f, 1.0f, 1.0f), Vec4(0.0f), Vec4(0.05f, 0.1f, 0.1f, 1.0f)});
    for (const Field field : {kWeight, kRadius, kMetal})
    {
        SceneBuilder builder;
        Material white = wax(Vec3(1.0f), Vec3(0.4f, 0.2f, 0.1f), 1.5f);
        if (field == kMetal) white.roughness = 0.0f; // rough metal loses light
        builder.add(mappedAlong(sphereMesh(Vec3(0.0f), 1.0f, 48), 0), textured(white, field));
        builder.scene->textures.push_back(texture);
        addSky(builder);
        const Estimate seen = measure(builder.build(), patchView({0, 0, 4}, {0, 0, 1}, 2.2, 32),
                                      optionsOf(IntegratorKind::Path, 64), 1);
        CAPTURE(int(field), seen.mean(), seen.standardError());
        CHECK(seen.agrees(1.0, 1e-3));
    }
}

TEST_CASE("subsurface textures: each half of a thick body has its own values",
          "[statistics][subsurface][long]")
{
    // The seam is 20 away, 80 mean ways. Each half is what a block of one colour is.
    const Vec3 left(0.9f, 0.2f, 0.5f), right(0.3f, 0.9f, 0.05f);
    const auto halves = blockOf(textured(wax(Vec3(1.0f), Vec3(0.25f)), kColor),
                                rowOf({Vec4(left, 1.0f), Vec4(right, 1.0f)}));
    for (const bool isLeft : {true, false})
    {
        const Estimate seen = patchAt(halves, isLeft ? -20.0 : 20.0, 2);
        const Estimate other = patchAt(halves, isLeft ? 20.0 : -20.0, 2);
        const Estimate expected =
            patchAt(blockOf(wax(isLeft ? left : right, Vec3(0.25f)), nullptr), 0.0, 2);
        CAPTURE(isLeft, seen.mean(), expected.mean(), seen.standardError());
        CHECK(seen.agrees(expected.mean(), 4.0 * expected.standardError()));
        CHECK(std::abs(other.mean() - expected.mean()) > 0.5); // green is 0.2 and 0.9
    }
    // Half of the block lets no light in, and is a Lambert surface.
    const auto masked =
        blockOf(textured(wax(Vec3(0.5f), Vec3(0.25f)), kWeight), rowOf({Vec4(0.0f), Vec4(1.0f)}));
    CHECK(patchAt(masked, -20.0, 2).agrees(0.5, 2e-4));
    const Estimate lit = patchAt(masked, 20.0, 2);
    const Estimate whole = patchAt(blockOf(wax(Vec3(0.5f), Vec3(0.25f)), nullptr), 20.0, 2);
    CHECK(lit.agrees(whole.mean(), 4.0 * whole.standardError()));
}

TEST_CASE("subsurface textures: the radius is that of the place where light leaves",
          "[statistics][subsurface]")
{
    // Each half of a thin slab has the reflectance of a whole slab of its radius, far from the
    // seam. The shorter the way, the less light goes through.
    const auto slabOf = [](const Material& material, const std::shared_ptr<const Texture>& texture)
    {
        SceneBuilder builder;
        builder.add(mappedAlong(boxMesh(Vec3(-20.0f, -20.0f, -0.5f), Vec3(20.0f, 20.0f, 0.0f)), 0),
                    material);
        if (texture) builder.scene->textures.push_back(texture);
        addHalfSky(builder, true);
        return builder.build();
    };
    const auto halves = slabOf(textured(wax(Vec3(0.9f), Vec3(0.5f)), kRadius),
                               rowOf({Vec4(1.0f), Vec4(0.1f, 0.1f, 0.1f, 1.0f)}));
    double means[2];
    for (const bool isLeft : {true, false})
    {
        const Estimate seen = patchAt(halves, isLeft ? -10.0 : 10.0, 2);
        const Estimate expected =
            patchAt(slabOf(wax(Vec3(0.9f), Vec3(isLeft ? 0.5f : 0.05f)), nullptr), 0.0, 2);
        CAPTURE(isLeft, seen.mean(), expected.mean(), seen.standardError());
        CHECK(seen.agrees(expected.mean(), 4.0 * expected.standardError()));
        means[isLeft ? 0 : 1] = seen.mean();
    }
    CHECK(means[1] > means[0] + 0.1);
}

TEST_CASE("subsurface textures: photons bring what paths find through a wall of two values",
          "[statistics][subsurface][long]")
{
    const View view = patchView({0.0f, -1.0f, 0.0f}, {0, 0, 1}, 0.8, 16);
    const Material plain = wax(Vec3(1.0f), Vec3(0.2f, 0.15f, 0.1f), 1.4f);
    const Material plainWhite = wax(Vec3(0.95f), Vec3(0.2f), 1.4f);
    const auto metal = [](float share) { return Vec4(0.0f, 1.0f, share, 1.0f); };
    const auto stripes = [](Vec4 even, Vec4 odd)
    {
        std::vector<Vec4> texels;
        for (int i = 0; i < 48; ++i)
            texels.push_back(i % 2 ? odd : even);
        return texels;
    };
    const struct
    {
        const char* name;
        Material material;
        std::vector<Vec4> texels;
        int axis = 1; // before, behind
    } cases[] = {
        {"dark where light leaves",
         textured(plain, kColor),
         {Vec4(0.5f, 0.4f, 0.6f, 1.0f), Vec4(0.95f, 0.95f, 0.9f, 1.0f)}},
        {"black where light enters",
         textured(plain, kColor),
         {Vec4(0.9f, 0.8f, 0.7f, 1.0f), Vec4(0.0f, 0.0f, 0.0f, 1.0f)}},
        {"half of the light leaves",
         textured(wax(Vec3(0.9f), Vec3(0.2f), 1.4f), kWeight),
         {Vec4(0.5f), Vec4(1.0f)}},
        {"a mask where light enters",
         textured(wax(Vec3(0.9f), Vec3(0.2f), 1.4f), kWeight),
         {Vec4(1.0f), Vec4(0.25f)}},
        {"black where light leaves",
         textured(plain, kColor),
         {Vec4(0.0f, 0.0f, 0.0f, 1.0f), Vec4(0.9f)}},
        {"stripes of metal", textured(plainWhite, kMetal), stripes(metal(1.0f), metal(0.0f)), 0},
        {"stripes that are nearly metal", textured(plainWhite, kMetal),
         stripes(metal(0.99f), metal(0.0f)), 0},
    };
    for (const auto& c : cases)
    {
        const auto traced = wallOf(c.material, rowOf(c.texels), c.axis);
        RenderOptions options = optionsOf(IntegratorKind::Path, 5);
        const Estimate expected = measure(traced, view, options, 6);
        options.photons = 10000;
        options.integrator = IntegratorKind::Sppm;
        const Estimate seen = measure(traced, view, options, 2);
        CAPTURE(c.name, seen.mean(), seen.standardError(), expected.mean(),
                expected.standardError());
        CHECK(expected.standardError() <= 0.03 * expected.mean());
        CHECK(seen.standardError() <= 0.03 * expected.mean());
        CHECK(seen.agrees(expected.mean(), 4.0 * expected.standardError()));
    }
}

TEST_CASE("subsurface textures: no look-up is above the largest texel", "[shading]")
{
    Texture texture = *rowOf({Vec4(0.1f, 0.5f, -1.0f, 1.0f), Vec4(0.4f, 0.2f, -2.0f, 1.0f)});
    CHECK(largestTexel(texture) == Vec3(0.4f, 0.5f, 0.0f));
    texture.wrapS = TextureWrap::ClampToBorder;
    texture.border = Vec4(0.3f, 0.7f, 0.1f, 1.0f);
    CHECK(largestTexel(texture) == Vec3(0.4f, 0.7f, 0.1f));
    Texture bytes;
    bytes.width = 2;
    bytes.height = 1;
    bytes.bytes = {0, 128, 255, 255, 51, 7, 0, 0};
    CHECK(largestTexel(bytes).x == Approx(0.2f));
    CHECK(largestTexel(bytes).y == Approx(128.0f / 255.0f));
    CHECK(largestTexel(bytes).z == 1.0f);
    CHECK(leastTexel(bytes, 0) == 0.0f);
    CHECK(leastTexel(bytes, 1) == Approx(7.0f / 255.0f));
    CHECK(leastTexel(texture, 1) == 0.2f);
    CHECK(leastTexel(texture, 0) == 0.1f);
    CHECK(leastTexel(texture, 2) == 0.0f);
    texture.border.x = 0.05f;
    CHECK(leastTexel(texture, 0) == 0.05f);
    bytes.decodeSrgb = true;
    CHECK(leastTexel(bytes, 1) == Approx(7.0f / 255.0f / 12.92f));
    CHECK(largestTexel(bytes).y == Approx(0.21586f).epsilon(1e-4));

    // Long images have a least and a largest texel, in turns, at every place.
    for (std::size_t texel = 0; texel < 37; ++texel)
    {
        CAPTURE(texel);
        Texture image;
        image.bytes.assign(4 * 37, 100);
        for (std::size_t c = 0; c < 3; ++c)
            image.bytes[4 * texel + c] = static_cast<uint8_t>(texel % 2 ? 200 + c : 50 - c);
        for (int c = 0; c < 3; ++c)
        {
            const float other = 100.0f / 255.0f;
            CHECK(largestTexel(image)[c] ==
                  (texel % 2 ? Approx(float(200 + c) / 255.0f) : Approx(other)));
            CHECK(leastTexel(image, c) ==
                  (texel % 2 ? Approx(other) : Approx(float(50 - c) / 255.0f)));
        }
    }
}
