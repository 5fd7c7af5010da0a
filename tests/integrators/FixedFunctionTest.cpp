// FixedFunctionTest.cpp - OpenGL's lighting equations, with shadows, as the Whitted integrator
// evaluates them.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Light sun(Vec3 direction)
{
    Light light;
    light.kind = LightKind::Directional;
    light.direction = glm::normalize(direction);
    light.diffuse = Vec3(0.5f, 0.4f, 0.3f);
    light.ambient = Vec3(0.1f);
    light.specular = Vec3(0.2f);
    return light;
}

Material phong()
{
    Material material;
    material.ambient = Vec3(0.3f, 0.2f, 0.1f);
    material.diffuse = Vec3(0.8f, 0.6f, 0.4f);
    material.emission = Vec3(0.02f);
    return material;
}

/// Returns a square at z = 0, to be seen from above.
SceneBuilder floorOf(const Material& material)
{
    SceneBuilder builder;
    auto quad = quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    quad->normals = std::vector<Vec3>(4, Vec3(0, 0, 1));
    builder.add(quad, material);
    builder.scene->ambient = Vec3(0.2f);
    return builder;
}

Vec3 seen(const SceneBuilder& builder, Vec3d normal = {0, 0, 1})
{
    const Picture picture = render(builder.build(), patchView({0, 0, 0}, normal, 0.01, 8),
                                   optionsOf(IntegratorKind::Whitted), 1);
    CHECK(picture.progress.droppedSamples == 0);
    return picture.mean();
}

void checkColor(Vec3 color, Vec3 expected)
{
    CHECK(color.x == Approx(expected.x).epsilon(1e-5));
    CHECK(color.y == Approx(expected.y).epsilon(1e-5));
    CHECK(color.z == Approx(expected.z).epsilon(1e-5));
}

} // namespace

TEST_CASE("fixed function: emission, ambient and diffuse terms", "[integrators]")
{
    SceneBuilder builder = floorOf(phong());
    builder.addLight(sun({0.6f, 0, -0.8f}));
    const Material m = phong();
    const Vec3 ambient = (Vec3(0.2f) + Vec3(0.1f)) * m.ambient + m.emission;
    checkColor(seen(builder), ambient + Vec3(0.5f, 0.4f, 0.3f) * m.diffuse * 0.8f);

    SceneBuilder shadowed = builder;
    shadowed.add(quadMesh({-3, -3, 3}, {6, 0, 0}, {0, 6, 0}), lambert(Vec3(0.5f)));
    checkColor(seen(shadowed), ambient); // ambient light has no shadows
}

TEST_CASE("fixed function: highlights with the viewer at infinity", "[integrators]")
{
    Material shiny = phong();
    shiny.specular = Vec3(0.5f);
    shiny.shininess = 10.0f;
    SceneBuilder builder = floorOf(shiny);
    builder.addLight(sun({0.6f, 0, -0.8f}));
    const Vec3 half = glm::normalize(Vec3(-0.6f, 0, 0.8f) + Vec3(0, 0, 1));
    const Vec3 base = (Vec3(0.2f) + Vec3(0.1f)) * shiny.ambient + shiny.emission +
                      Vec3(0.5f, 0.4f, 0.3f) * shiny.diffuse * 0.8f;
    checkColor(seen(builder), base + Vec3(0.2f * 0.5f * std::pow(half.z, 10.0f)));
}

TEST_CASE("fixed function: light masks, unlit surfaces and clamping", "[integrators]")
{
    Material masked = phong();
    masked.lightMask = 1u << 3;
    SceneBuilder builder = floorOf(masked);
    Light light = sun({0, 0, -1});
    light.number = 0;
    builder.addLight(light);
    checkColor(seen(builder), Vec3(0.2f) * masked.ambient + masked.emission);
    light.number = 3;
    builder.scene->lights[0] = light;
    checkColor(seen(builder),
               Vec3(0.3f) * masked.ambient + masked.emission + light.diffuse * masked.diffuse);

    Material unlit = phong();
    unlit.lit = false;
    SceneBuilder plain = floorOf(unlit);
    plain.addLight(light);
    checkColor(seen(plain), unlit.diffuse);

    SceneBuilder bright = floorOf(phong());
    light.number = 0;
    light.diffuse = Vec3(9.0f);
    bright.addLight(light);
    bright.scene->displayReferred = true; // clamped to 1, as OpenGL displays it
    checkColor(seen(bright), Vec3(1.0f));
}

TEST_CASE("fixed function: back faces keep their normal unless lighting is two-sided",
          "[integrators]")
{
    Material material = phong();
    SceneBuilder builder = floorOf(material);
    builder.addLight(sun({0, 0, 1})); // shines from below
    const Vec3 ambient = Vec3(0.3f) * material.ambient + material.emission;
    checkColor(seen(builder, {0, 0, -1}), ambient);
    material.twoSidedLighting = true;
    SceneBuilder twoSided = floorOf(material);
    twoSided.addLight(sun({0, 0, 1}));
    checkColor(seen(twoSided, {0, 0, -1}), ambient + Vec3(0.5f, 0.4f, 0.3f) * material.diffuse);
}

TEST_CASE("fixed function: a headlight follows the view", "[integrators]")
{
    Light head = sun({0, 0, -1});
    head.eyeSpace = true;
    for (const Vec3d& normal : {Vec3d(0, 0, 1), glm::normalize(Vec3d(0.6, 0, 0.8))})
    {
        SceneBuilder builder = floorOf(phong());
        builder.addLight(head);
        const Material m = phong();
        const Vec3 ambient = Vec3(0.3f) * m.ambient + m.emission;
        checkColor(seen(builder, normal), ambient + head.diffuse * m.diffuse * float(normal.z));
    }
}

TEST_CASE("lights without shadows light what faces them, and cost no shadow rays", "[integrators]")
{
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
    {
        for (const bool physical : {false, true})
        {
            const Vec3 color(0.8f, 0.6f, 0.4f);
            SceneBuilder builder = floorOf(physical ? lambert(color) : phong());
            builder.scene->ambient = Vec3(0.0f);
            for (Material& material : builder.scene->materials)
                material.emission = Vec3(0.0f);
            Light light = sun({0.6f, 0, -0.8f});
            light.ambient = Vec3(0.0f);
            light.castsShadows = false;
            builder.addLight(light);
            builder.add(quadMesh({-3, -3, 3}, {6, 0, 0}, {0, 6, 0}), lambert(Vec3(0.0f)));
            const View view = patchView({0, 0, 0}, {0, 0, 1}, 0.01, 8);
            const Picture picture = render(builder.build(), view, optionsOf(kind, 1), 1);
            CAPTURE(int(kind), physical);
            checkColor(picture.mean(), light.diffuse * color * 0.8f);
            CHECK(picture.progress.rays.shadow == 0);

            builder.scene->lights[0].castsShadows = true;
            CHECK(render(builder.build(), view, optionsOf(kind, 1), 1).mean() == Vec3(0.0f));
        }
    }
}

TEST_CASE("fixed function: physical surfaces show the same brightness under the same light",
          "[integrators]")
{
    SceneBuilder builder;
    builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(0.8f, 0.6f, 0.4f)));
    builder.addLight(sun({0.6f, 0, -0.8f}));
    const View view = patchView({0, 0, 0}, {0, 0, 1}, 0.01, 8);
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
        checkColor(render(builder.build(), view, optionsOf(kind), 1).mean(),
                   Vec3(0.5f, 0.4f, 0.3f) * Vec3(0.8f, 0.6f, 0.4f) * 0.8f);
}
