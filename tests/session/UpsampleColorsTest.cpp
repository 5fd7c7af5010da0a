// UpsampleColorsTest.cpp - upsampled images: light is coarse, the surfaces' own colours are not.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"
#include "tests/session/CentredPass.h"

#include "osgRayTrace/session/upsample/Upsample.h"

#include <cmath>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kWidth = 160, kHeight = 120;

View frontView()
{
    return perspectiveView({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 50.0, kWidth, kHeight);
}

struct Compared
{
    ResolvedImage image, reference;
    UpsampleCounts counts;
};

/// Upsamples an image of 1/divider of the size with all pixels traced.
Compared upsampled(const std::shared_ptr<const TracedScene>& scene, int divider, int threads = 2)
{
    RenderSession session(std::make_shared<Workers>(threads));
    Compared result;
    result.reference = centredImage(session, scene, frontView());
    View smaller = frontView();
    smaller.width /= divider;
    smaller.height /= divider;
    const ResolvedImage small = centredImage(session, scene, smaller);
    result.counts = session.upsample(small, session.surfaceSamples(), kWidth, kHeight, result.image,
                                     kAllTraced);
    REQUIRE(result.image.radiance.size() == result.reference.radiance.size());
    return result;
}

/// Returns how many values differ by more than a share of the expected one and a bit.
int differences(const Compared& c, float share, float bit)
{
    int count = 0;
    for (std::size_t i = 0; i < c.image.radiance.size(); ++i)
    {
        const float expected = c.reference.radiance[i];
        count += !(std::fabs(c.image.radiance[i] - expected) <= share * expected + bit);
    }
    return count;
}

/// Returns a texture of random texels between two values, which no image of fewer pixels shows.
std::shared_ptr<Texture> noise(int low, int high, bool linear)
{
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 64;
    texture->linearFilter = linear;
    Uniform random(7);
    for (int i = 0; i < 4 * 64 * 64; ++i)
        texture->bytes.push_back(static_cast<uint8_t>(float(low) + random() * float(high - low)));
    return texture;
}

/// Returns a wall that fills the view, with a texture over it.
std::shared_ptr<Mesh> wall()
{
    auto mesh = quadMesh({-5, -4, 0}, {10, 0, 0}, {1, 8, 0});
    mesh->uvs = std::vector<Vec2>{{0, 0}, {1.7f, 0}, {1.7f, 1.7f}, {0, 1.7f}};
    return mesh;
}

/// Returns a light that is the same everywhere on a wall.
Light sun()
{
    Light light;
    light.kind = LightKind::Directional;
    light.direction = Vec3(0.0f, 0.0f, -1.0f);
    light.diffuse = Vec3(0.7f, 0.6f, 0.5f);
    light.castsShadows = false;
    return light;
}

} // namespace

TEST_CASE("upsampled colours: a diffuse texture under constant light is exact",
          "[session][upsample]")
{
    for (const bool linear : {true, false})
    {
        SceneBuilder builder;
        builder.scene->textures.push_back(noise(10, 250, linear));
        Material material = lambert(Vec3(0.9f, 0.8f, 1.0f));
        material.baseColorTexture = 0;
        builder.add(wall(), material);
        builder.scene->lights.push_back(sun());
        const auto scene = builder.build();
        for (const int divider : {2, 4, 8})
        {
            const Compared c = upsampled(scene, divider);
            CAPTURE(linear, divider);
            CHECK(c.counts.traced == kWidth * kHeight);
            CHECK(differences(c, 0.01f, 1e-4f) == 0);
        }
    }
}

TEST_CASE("upsampled colours: an unlit texture is exact", "[session][upsample]")
{
    SceneBuilder builder;
    builder.scene->textures.push_back(noise(0, 255, true));
    Material material;
    material.lit = false;
    material.diffuse = Vec3(1.0f, 0.5f, 0.25f);
    material.baseColorTexture = 0;
    builder.add(wall(), material);
    CHECK(differences(upsampled(builder.build(), 8), 0.01f, 0.002f) == 0);
}

TEST_CASE("upsampled colours: lines of one pixel are whole, whatever lies between samples",
          "[session][upsample]")
{
    const float pixel = 2.0f * 6.0f * std::tan(glm::radians(25.0f)) / kHeight;
    SceneBuilder builder;
    builder.add(quadMesh({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), lambert(Vec3(0.04f)));
    for (int i = 0; i < 9; ++i)
    {
        const float y = -2.6f + 0.6f * static_cast<float>(i);
        builder.add(quadMesh({-4, y, 0.001f}, {8, 0.3f, 0}, {0, 1.3f * pixel, 0}),
                    lambert(Vec3(0.9f)));
    }
    builder.scene->lights.push_back(sun());
    const auto scene = builder.build();
    for (const int divider : {4, 8})
    {
        const Compared c = upsampled(scene, divider);
        CAPTURE(divider, c.counts.unlike);
        CHECK(differences(c, 0.03f, 1e-4f) == 0);
    }
}

TEST_CASE("upsampled colours: black surfaces stay black and take no light from others",
          "[session][upsample]")
{
    SceneBuilder builder;
    builder.scene->textures.push_back(noise(0, 1, false)); // 0 alone
    Material black = lambert(Vec3(1.0f));
    black.baseColorTexture = 0;
    builder.add(wall(), black);
    builder.add(quadMesh({-1, -1, 0.001f}, {0.8f, 0, 0}, {0.4f, 2, 0}), lambert(Vec3(0.9f)));
    builder.add(quadMesh({1, -1, 0.001f}, {0.8f, 0, 0}, {0.4f, 2, 0}),
                lamp(Vec3(50.0f, 20.0f, 0.0f)));
    builder.scene->lights.push_back(sun());
    for (const int divider : {2, 4, 8})
    {
        const Compared c = upsampled(builder.build(), divider);
        int dark = 0, leaks = 0;
        for (std::size_t i = 0; i < c.image.radiance.size(); ++i)
        {
            REQUIRE(std::isfinite(c.image.radiance[i]));
            if (c.reference.radiance[i] > 0.0f) continue;
            ++dark;
            leaks += c.image.radiance[i] > 0.004f;
        }
        CAPTURE(divider, dark);
        CHECK(dark > kWidth * kHeight);
        CHECK(leaks == 0);
        CHECK(differences(c, 0.02f, 0.004f) == 0);
    }
}

TEST_CASE("upsampled colours: the same for any number of threads", "[session][upsample]")
{
    SceneBuilder builder;
    builder.add(wall(), lambert(Vec3(0.5f)));
    builder.add(sphereMesh({0, 0, 1}, 1.0f, 12), lambert(Vec3(0.8f)));
    builder.scene->lights.push_back(pointLight({3, 3, 6}));
    const auto scene = builder.build();
    const Compared one = upsampled(scene, 4, 1), three = upsampled(scene, 4, 3);
    CHECK((one.image.radiance == three.image.radiance));
    CHECK((one.image.depth == three.image.depth));
    REQUIRE_FALSE((one.image.radiance == one.reference.radiance));
}

TEST_CASE("upsampled colours: what samples record is the albedo of the first hit",
          "[session][upsample]")
{
    SceneBuilder builder;
    builder.scene->textures = {noise(0, 255, true), noise(0, 255, false)};
    std::vector<Material> materials(6, lambert(Vec3(0.6f, 0.5f, 0.4f)));
    materials[1].metallic = 0.5f;
    materials[1].baseColorTexture = 0;
    for (std::size_t i = 2; i < 6; ++i)
    {
        materials[i] = Material();
        materials[i].diffuse = Vec3(0.9f, 0.4f, 0.7f);
        materials[i].baseColorTexture = i % 2;
    }
    materials[3].vertexColorUse = VertexColorUse::AmbientAndDiffuse;
    materials[4].textureEnvironment = TextureEnvironment::Replace;
    materials[5].textureEnvironment = TextureEnvironment::Blend;
    materials[5].specular = Vec3(0.5f);
    for (std::size_t i = 0; i < materials.size(); ++i)
    {
        auto mesh = wall();
        mesh->positions = std::vector<Vec3>{{-4 + 1.3f * i, -3, 0},
                                            {-2.8f + 1.3f * i, -3, 0.1f},
                                            {-2.8f + 1.3f * i, 3, 0},
                                            {-4 + 1.3f * i, 3, 0.2f}};
        mesh->colors = std::vector<Vec4>{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}};
        builder.add(mesh, materials[i]);
    }
    builder.scene->lights.push_back(sun());
    RenderSession session(std::make_shared<Workers>(1));
    centredImage(session, builder.build(), frontView());
    const std::vector<float> albedos = session.resolveChannel(Channel::Albedo);
    const std::vector<SurfaceSample>& samples = session.surfaceSamples();
    int hits = 0, wrong = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
        hits += samples[i].object != 0;
        for (std::size_t c = 0; c < 3; ++c)
            wrong += !(std::fabs(samples[i].albedo[int(c)] - albedos[3 * i + c]) <= 1e-5f);
    }
    CHECK(hits > kWidth * kHeight / 2);
    CHECK(wrong == 0);
}
