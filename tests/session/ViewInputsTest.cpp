// ViewInputsTest.cpp - which inputs of a view ask for another image. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/ViewInputs.h"

#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/photons/PhotonPasses.h"

#include <functional>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("view inputs: whatever differs asks for another image, a copy does not", "[session]")
{
    ViewInputs inputs;
    inputs.scene = cornellBox().build();
    inputs.workers = std::make_shared<Workers>(1);
    inputs.photons = std::make_shared<PhotonPasses>();
    CHECK(sameImage(inputs, ViewInputs(inputs)));

    const std::function<void(ViewInputs&)> changes[] = {
        [](ViewInputs& other) { other.scene = cornellBox().build(); },
        [](ViewInputs& other) { other.workers = std::make_shared<Workers>(1); },
        [](ViewInputs& other) { other.photons = std::make_shared<PhotonPasses>(); },
        [](ViewInputs& other) { other.options.maxBounces += 1; },
        [](ViewInputs& other) { other.exposureEv = 1.0f; },
        [](ViewInputs& other) { other.denoise = DenoiseKind::Filter; },
        [](ViewInputs& other) { other.reprojects = true; },
        [](ViewInputs& other) { other.keepsUnchanged = true; },
        [](ViewInputs& other) { other.maxPasses = 2; },
        [](ViewInputs& other) { other.passesPerFrame = 2; },
    };
    int number = 0;
    for (const auto& change : changes)
    {
        CAPTURE(number++);
        ViewInputs other = inputs;
        change(other);
        CHECK_FALSE(sameImage(inputs, other));
        CHECK_FALSE(sameImage(other, inputs));
    }
}

TEST_CASE("view inputs: the tone map has the exposure of the inputs and the scene's colour rule",
          "[session]")
{
    ViewInputs inputs;
    inputs.exposureEv = 2.0f;
    inputs.scene = cornellBox().build();
    CHECK(toneMapOf(inputs) == ToneMap{2.0f, inputs.scene->scene().displayReferred});
    auto shown = std::make_shared<Scene>(inputs.scene->scene());
    shown->displayReferred = !shown->displayReferred;
    inputs.scene = TracedScene::build(shown, std::make_shared<Workers>(1));
    CHECK(toneMapOf(inputs) == ToneMap{2.0f, shown->displayReferred});
}

TEST_CASE("view inputs: media veil a background that is opaque, in linear light alone", "[session]")
{
    ViewInputs inputs;
    Medium haze;
    haze.sigmaA = Vec3(0.1f);
    const auto toneMapWith = [&inputs](Vec4 background, const Medium& medium, bool displayReferred)
    {
        auto shown = std::make_shared<Scene>(cornellBox().build()->scene());
        shown->atmosphere = std::make_shared<Atmosphere>(Atmosphere{medium});
        shown->background = background;
        shown->displayReferred = displayReferred;
        inputs.scene = TracedScene::build(shown, std::make_shared<Workers>(1));
        return toneMapOf(inputs);
    };
    const ToneMap veiled = toneMapWith(Vec4(1.0f, 0.0f, 0.25f, 1.0f), haze, false);
    CHECK(veiled.veiled);
    CHECK(veiled.background.x == Approx(1.0f));
    CHECK(veiled.background.y == 0.0f);
    CHECK(veiled.background.z == Approx(srgbFromLinear(0.25f)));
    CHECK_FALSE(toneMapWith(Vec4(1.0f, 0.0f, 0.25f, 0.5f), haze, false).veiled);
    CHECK_FALSE(toneMapWith(Vec4(1.0f, 0.0f, 0.25f, 1.0f), haze, true).veiled);
    CHECK_FALSE(toneMapWith(Vec4(1.0f, 0.0f, 0.25f, 1.0f), Medium(), false).veiled);
}
