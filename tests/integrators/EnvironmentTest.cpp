// EnvironmentTest.cpp - light from environments compared with closed forms, by every estimator.
// SPDX-License-Identifier: MIT
#include "tests/Environments.h"
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

struct Sky
{
    const char* name;
    std::shared_ptr<const EnvironmentImage> image;
    Mat3 mapFromEngine;
    double irradiance; ///< of a surface that faces +z
};

/// Returns environments whose closed forms hold for the rows and columns as they are, each of
/// constant radiance.
std::vector<Sky> skies()
{
    std::vector<Sky> skies;
    skies.push_back({"even", newEnvironment(8, 4, Vec3(1.0f)), Mat3(1.0f), M_PI});

    const auto half = newEnvironment(64, 32, [](Vec3d d) { return Vec3(d.x > 0.0 ? 1.0f : 0.0f); });
    skies.push_back({"half", half, Mat3(1.0f), 0.5 * M_PI});

    // The light comes from the lune between the horizon and a plane tilted by 60 degrees from it: E
    // = pi (1 + cos 120) / 2.
    const auto upper =
        newEnvironment(64, 32, [](Vec3d d) { return Vec3(d.z > 0.0 ? 1.0f : 0.0f); });
    skies.push_back({"turned half", upper, tilted(float(2.0 * M_PI / 3.0)), M_PI * 0.25});

    const double power = 5.0;
    const auto lobe = newEnvironment(
        256, 128, [&](Vec3d d) { return Vec3(d.z > 0.0 ? float(std::pow(d.z, power)) : 0.0f); });
    skies.push_back({"cos^5", lobe, Mat3(1.0f), 2.0 * M_PI / (power + 2.0)});

    const int rows = 150;
    const double discAngle = 3.0 * M_PI / rows;
    const auto disc = newEnvironment(
        300, rows, [&](Vec3d d) { return Vec3(d.z > std::cos(discAngle) ? 100.0f : 0.0f); });
    const double inZenith = 100.0 * M_PI * std::sin(discAngle) * std::sin(discAngle);
    skies.push_back({"sun disc above", disc, Mat3(1.0f), inZenith});
    skies.push_back({"sun disc at 60 degrees", disc, tilted(float(M_PI / 3.0)), inZenith * 0.5});
    return skies;
}

std::shared_ptr<const TracedScene> receiverUnder(const Light& environment)
{
    SceneBuilder builder;
    builder.add(quadMesh({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), lambert(Vec3(1.0f)));
    builder.addLight(environment);
    return builder.build();
}

View receiverView()
{
    return patchView({0, 0, 0}, {0, 0, 1}, 1e-3, 16);
}

RenderOptions sampledBy(EnvironmentSampling sampling, RenderOptions options)
{
    options.environmentSampling = sampling;
    return options;
}

/// Returns a floor and two blocks on it, one of which is shiny.
SceneBuilder blocks()
{
    SceneBuilder builder;
    builder.add(quadMesh({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), lambert(Vec3(0.7f, 0.6f, 0.5f)));
    builder.add(boxMesh({-1.5f, -0.5f, 0}, {-0.5f, 0.5f, 1.5f}), lambert(Vec3(0.3f, 0.6f, 0.3f)));
    Material shiny = mirror(Vec3(0.9f));
    shiny.roughness = 0.4f;
    builder.add(sphereMesh({0.8f, 0, 0.7f}, 0.7f, 24), shiny);
    return builder;
}

View blocksView(int pixels)
{
    return perspectiveView({0, -6, 3}, {0, 0, 0.5}, {0, 0, 1}, 40.0, pixels, pixels);
}

} // namespace

TEST_CASE("environment: irradiance of closed forms by paths and by Whitted's samples",
          "[integrators][statistics][long]")
{
    for (const Sky& sky : skies())
    {
        const auto traced = receiverUnder(environmentLight(sky.image, sky.mapFromEngine));
        for (const EnvironmentSampling sampling :
             {EnvironmentSampling::Importance, EnvironmentSampling::Uniform})
        {
            // cos^5 is sampled at the middles of 128 rows: its closed form is right to 1e-4.
            const double rounding = 1e-4;
            const Estimate path =
                measure(traced, receiverView(),
                        sampledBy(sampling, optionsOf(IntegratorKind::Path, 2)), 64);
            RenderOptions options = sampledBy(sampling, optionsOf(IntegratorKind::Whitted));
            options.lightSamples = 16;
            const Estimate whitted = measure(traced, receiverView(), options, 4);
            CAPTURE(sky.name, int(sampling), sky.irradiance, path.mean() * M_PI,
                    path.standardError() * M_PI, whitted.mean() * M_PI,
                    whitted.standardError() * M_PI);
            CHECK(path.agrees(sky.irradiance / M_PI, rounding * sky.irradiance));
            CHECK(whitted.agrees(sky.irradiance / M_PI, rounding * sky.irradiance));
            if (sampling == EnvironmentSampling::Importance)
                CHECK(path.standardError() < 3e-3 * sky.irradiance);
        }
    }
}

TEST_CASE("environment: one pixel of 1e9 on 0.5", "[integrators][statistics][stability 29]")
{
    const int width = 4096, height = 2048, x = 3000, y = 1500;
    const auto image = newEnvironment(width, height, Vec3(0.5f));
    pixelOf(*image, x, y) = Vec3(1e9f);
    const EnvironmentMap map(image);
    const double cosine = map.direction(x + 0.5, y + 0.5).z;
    const double exact = M_PI * 0.5 + (1e9 - 0.5) * map.solidAngle(y) * cosine;
    const auto traced = receiverUnder(environmentLight(image));
    const Estimate path = measure(traced, receiverView(), optionsOf(IntegratorKind::Path, 2), 64);
    CAPTURE(exact, path.mean() * M_PI, path.standardError() * M_PI);
    CHECK(path.agrees(exact / M_PI, 1e-5 * exact));
    CHECK(std::fabs(path.mean() * M_PI / exact - 1.0) < 0.005);

    // In the shadow of this pixel only the sky gives light.
    SceneBuilder builder;
    builder.add(quadMesh({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), lambert(Vec3(1.0f)));
    const Vec3 towards(map.direction(x + 0.5, y + 0.5));
    builder.add(sphereMesh(towards * 100.0f, 1.0f, 24), lambert(Vec3(0.0f)));
    builder.addLight(environmentLight(image));
    const Estimate shadow =
        measure(builder.build(), receiverView(), optionsOf(IntegratorKind::Path, 2), 64);
    CAPTURE(shadow.mean(), shadow.standardError());
    CHECK(shadow.agrees(0.5, 1e-4));
}

TEST_CASE("environment: structured sampling has no noise, and its bias is small", "[integrators]")
{
    for (const Sky& sky : skies())
    {
        const auto traced = receiverUnder(environmentLight(sky.image, sky.mapFromEngine));
        RenderOptions options =
            sampledBy(EnvironmentSampling::Structured, optionsOf(IntegratorKind::Whitted));
        const Picture picture = render(traced, receiverView(), options, 1);
        options.seed = 77;
        CHECK(render(traced, receiverView(), options, 1).rgba == picture.rgba);
        options.integrator = IntegratorKind::Path; // a path of one edge has only the strata
        options.maxBounces = 1;
        const Picture path = render(traced, receiverView(), options, 1);
        for (int p = 0; p < 256; ++p)
        {
            CHECK(picture.at(p % 16, p / 16) == picture.at(0, 0));
            CHECK(std::fabs(path.at(p % 16, p / 16).y / picture.at(0, 0).y - 1.0f) < 1e-5f);
        }
        const double bias = picture.mean().y * M_PI / sky.irradiance - 1.0;
        CAPTURE(sky.name, bias); // measured: 1.8e-3, 9.3e-3, -9.7e-3, 1.9e-3, 6e-5, 5e-5
        CHECK(std::fabs(bias) < 0.015);
    }
}

TEST_CASE("environment: black is black, and one pixel is enough", "[integrators][stability 30]")
{
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted,
                                      IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
        for (const EnvironmentSampling sampling :
             {EnvironmentSampling::Importance, EnvironmentSampling::Structured,
              EnvironmentSampling::Uniform})
        {
            SceneBuilder builder = blocks();
            builder.add(sphereMesh({0, -2, 0.5f}, 0.4f, 12), glass(1.5f));
            const SceneBuilder bare = builder;
            builder.addLight(environmentLight(newEnvironment(64, 32, Vec3(0.0f))));
            const Picture black =
                render(builder.build(), blocksView(32), sampledBy(sampling, optionsOf(kind)), 2);
            CHECK(black.progress.droppedSamples == 0);
            CHECK(black.mean() == Vec3(0.0f));
        }
    const auto traced = receiverUnder(environmentLight(newEnvironment(1, 1, Vec3(2.0f))));
    CHECK(
        measure(traced, receiverView(), optionsOf(IntegratorKind::Path, 2), 16).agrees(2.0, 1e-5));
}

TEST_CASE("furnace: nothing is seen of white and clear things under an even sky",
          "[integrators][statistics][long]")
{
    SceneBuilder builder;
    builder.add(sphereMesh({-1.2f, 0, 0}, 1.0f, 48), lambert(Vec3(1.0f)));
    builder.add(sphereMesh({1.2f, 0, 0}, 1.0f, 48), glass(1.5f));
    builder.add(sphereMesh({0, 2.4f, 0}, 1.0f, 48), mirror(Vec3(1.0f)));
    builder.addLight(environmentLight(newEnvironment(16, 8, Vec3(1.0f))));
    const auto traced = builder.build();
    // Light goes round in glass of many facets: beyond 512 edges 5e-5 of the picture is left,
    // beyond 64 edges 3e-4.
    const View view = perspectiveView({0, 0.8, 8}, {0, 0.8, 0}, {0, 1, 0}, 40.0, 48, 48);
    for (const EnvironmentSampling sampling :
         {EnvironmentSampling::Importance, EnvironmentSampling::Uniform})
    {
        const Estimate path =
            measure(traced, view, sampledBy(sampling, optionsOf(IntegratorKind::Path, 512)), 16);
        CAPTURE(int(sampling), path.mean(), path.standardError());
        CHECK(path.agrees(1.0, 1e-4));
        CHECK(path.standardError() < 2e-3);
    }
    // Whitted computes direct light only, which is all the light that the white ball gets if it has
    // no neighbours.
    SceneBuilder alone;
    alone.add(sphereMesh({0, 0, 0}, 1.0f, 48), lambert(Vec3(1.0f)));
    alone.addLight(environmentLight(newEnvironment(16, 8, Vec3(1.0f))));
    const View near = perspectiveView({0, 0, 8}, {0, 0, 0}, {0, 1, 0}, 16.0, 48, 48);
    for (const EnvironmentSampling sampling :
         {EnvironmentSampling::Importance, EnvironmentSampling::Uniform})
        CHECK(measure(alone.build(), near, sampledBy(sampling, optionsOf(IntegratorKind::Whitted)),
                      16)
                  .agrees(1.0, 1e-3));
}

TEST_CASE("environment: all ways to sample it have the same mean",
          "[integrators][statistics][long]")
{
    SceneBuilder builder = blocks();
    builder.addQuadLight({1, 1, 3}, {0, 1, 0}, {1, 0, 0}, Vec3(3.0f)); // beside the environment
    builder.addLight(environmentLight(sunnySky(32, 16)));
    const auto traced = builder.build();
    const Estimate importance =
        measure(traced, blocksView(32), optionsOf(IntegratorKind::Path, 6), 64);
    const Estimate uniform =
        measure(traced, blocksView(32),
                sampledBy(EnvironmentSampling::Uniform, optionsOf(IntegratorKind::Path, 6)), 256);
    const Estimate structured =
        measure(traced, blocksView(32),
                sampledBy(EnvironmentSampling::Structured, optionsOf(IntegratorKind::Path, 6)), 4);
    CAPTURE(importance.mean(), importance.standardError(), uniform.mean(), uniform.standardError(),
            structured.mean(), structured.standardError());
    // Both means have an error: of 16 values each, with a false alarm in 1,000 runs.
    CHECK(std::fabs(importance.mean() - uniform.mean()) <
          4.0 * std::hypot(importance.standardError(), uniform.standardError()));
    CHECK(importance.standardError() < 2e-3 * importance.mean());
    CHECK(uniform.standardError() < 0.02 * uniform.mean());
    CHECK(std::fabs(structured.mean() / importance.mean() - 1.0) < 0.02);
}

TEST_CASE("environment: with a sun, importance sampling needs twenty times less",
          "[integrators][statistics][long]")
{
    SceneBuilder builder = blocks();
    builder.addLight(environmentLight(sunnySky(64, 32)));
    const auto traced = builder.build();
    const View view = blocksView(48);
    RenderOptions options = optionsOf(IntegratorKind::Path, 4);
    options.seed = 9;
    const Picture reference = render(traced, view, options, 4096);
    // The error is taken over the pixels that show something lit. Passes are independent, so the
    // error is proportional to 1 / passes.
    const auto relativeSquaredError = [&](EnvironmentSampling sampling, int passes, double& rays)
    {
        RenderOptions with = sampledBy(sampling, optionsOf(IntegratorKind::Path, 4));
        const Picture picture = render(traced, view, with, passes);
        rays = double(picture.progress.rays.shadow + picture.progress.rays.secondary +
                      picture.progress.rays.camera);
        double sum = 0.0;
        for (int p = 0; p < 48 * 48; ++p)
        {
            const double exact = reference.at(p % 48, p / 48).y;
            const double error = picture.at(p % 48, p / 48).y - exact;
            sum += error * error / (exact * exact + 1e-4);
        }
        return sum / (48 * 48);
    };
    double importanceRays, uniformRays;
    const double importance =
        relativeSquaredError(EnvironmentSampling::Importance, 16, importanceRays);
    const double uniform = relativeSquaredError(EnvironmentSampling::Uniform, 16, uniformRays);
    CAPTURE(importance, uniform, importanceRays, uniformRays);
    CHECK(uniform * uniformRays > 20.0 * importance * importanceRays);
}

TEST_CASE("environment: without one mirrors show the background, and it lights nothing",
          "[integrators]")
{
    for (const float roughness : {0.0f, 0.05f, 1.0f})
    {
        Material metal = mirror(Vec3(1.0f));
        metal.roughness = roughness;
        SceneBuilder builder;
        builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), metal);
        builder.scene->background = Vec4(0.25f, 0.5f, 1.0f, 1.0f);
        const auto traced = builder.build();
        for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted,
                                          IntegratorKind::Ppm, IntegratorKind::PhotonCaustics})
        {
            const Picture picture =
                render(traced, patchView({0, 0, 0}, {0, 0, 1}, 0.5, 16), optionsOf(kind), 4);
            const float* p = &picture.rgba[(8 * 16 + 8) * 4];
            const Vec3 wanted = roughness == 0.0f ? Vec3(0.25f, 0.5f, 1.0f) : Vec3(0.0f);
            CAPTURE(roughness, int(kind));
            CHECK(glm::length(Vec3(p[0], p[1], p[2]) - wanted) < 1e-4f);
            CHECK(p[3] == 1.0f);
        }
    }
}

TEST_CASE("environment: visible or not to camera rays, always in mirrors", "[integrators]")
{
    SceneBuilder builder;
    builder.add(quadMesh({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}), mirror(Vec3(1.0f)));
    builder.scene->background = Vec4(0.25f, 0.25f, 0.25f, 1.0f);
    Light light = environmentLight(newEnvironment(4, 2, Vec3(1, 2, 3)));
    light.radiance = Vec3(2.0f, 1.0f, 1.0f);
    for (const bool visible : {true, false})
    {
        light.environment.visible = visible;
        SceneBuilder with = builder;
        with.scene = std::make_shared<Scene>(*builder.scene);
        with.addLight(light);
        const auto traced = with.build();
        for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted,
                                          IntegratorKind::Ppm, IntegratorKind::PhotonCaustics})
        {
            const Picture picture =
                render(traced, patchView({0, 0, 0}, {0, 0, 1}, 1.0, 16), optionsOf(kind), 4);
            CAPTURE(visible, int(kind));
            const std::size_t mirrored = (2 * 16 + 8) * 4, missed = (13 * 16 + 8) * 4;
            const float* m = &picture.rgba[mirrored];
            const float* b = &picture.rgba[missed];
            CHECK(glm::length(Vec3(m[0], m[1], m[2]) - Vec3(2, 2, 3)) < 1e-4f);
            CHECK(m[3] == 1.0f);
            CHECK(glm::length(Vec3(b[0], b[1], b[2]) - (visible ? Vec3(2, 2, 3) : Vec3(0.0f))) <
                  1e-4f);
            CHECK(b[3] == (visible ? 1.0f : 0.0f));
        }
    }
}

TEST_CASE("environment: fixed-function surfaces get its light", "[integrators][statistics]")
{
    Material plain;
    plain.model = MaterialModel::FixedFunction;
    plain.diffuse = Vec3(0.5f);
    plain.ambient = Vec3(0.0f);
    SceneBuilder builder;
    builder.scene->ambient = Vec3(0.0f);
    builder.add(quadMesh({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), plain);
    builder.addLight(environmentLight(newEnvironment(8, 4, Vec3(1.0f))));
    const auto traced = builder.build();
    CHECK(traced->traits().environment);
    CHECK_FALSE(traced->traits().areaLights);
    CHECK_FALSE(traced->traits().deltaLights);
    CHECK(measure(traced, receiverView(), optionsOf(IntegratorKind::Automatic), 16)
              .agrees(0.5, 1e-3));
}

TEST_CASE("environment: the same image for any number of threads", "[integrators]")
{
    SceneBuilder builder = blocks();
    builder.add(sphereMesh({0, -2, 0.5f}, 0.4f, 16), glass(1.5f));
    builder.addLight(environmentLight(sunnySky(64, 32)));
    for (const IntegratorKind kind :
         {IntegratorKind::Path, IntegratorKind::Whitted, IntegratorKind::PhotonCaustics})
        for (const EnvironmentSampling sampling :
             {EnvironmentSampling::Importance, EnvironmentSampling::Structured})
        {
            RenderOptions options = sampledBy(sampling, optionsOf(kind));
            options.environmentSamples = 20;
            const Picture one = render(builder.build(1), blocksView(40), options, 3, 1);
            const Picture four = render(builder.build(4), blocksView(40), options, 3, 4);
            CAPTURE(int(kind), int(sampling));
            CHECK(one.rgba == four.rgba);
            CHECK(one.progress.droppedSamples == 0);
        }
}

TEST_CASE("environment: one without an image is no light, and the next one shines", "[integrators]")
{
    Light lost;
    lost.kind = LightKind::Environment;
    lost.radiance = Vec3(1.0f);
    SceneBuilder dark, lit;
    for (SceneBuilder* builder : {&dark, &lit})
    {
        builder->add(quadMesh({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), lambert(Vec3(1.0f)));
        builder->addLight(lost);
    }
    lit.addLight(environmentLight(newEnvironment(8, 4, Vec3(1.0f))));
    CHECK_FALSE(sceneTraits(*dark.scene).environment);
    CHECK(sceneTraits(*lit.scene).environment);
    CHECK(dark.build()->lights().environment() == nullptr);
    const auto traced = lit.build();
    const PlacedEnvironment* found = traced->lights().environment();
    REQUIRE(found);
    CHECK(found->light() == lit.scene->lights.size() - 1);
}
