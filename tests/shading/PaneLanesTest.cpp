// PaneLanesTest.cpp - sixteen rays at clear panes compared with one ray at a time. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/shading/LayeredBsdf.h"
#include "osgRayTrace/shading/PaneLanes.h"

#include <cmath>

using namespace osgRayTrace::engine;

namespace
{

Bsdf pane(float eta, Vec3 transmission)
{
    const float root = (eta - 1.0f) / (eta + 1.0f);
    Bsdf bsdf;
    bsdf.thin = true;
    bsdf.alpha = 0.0f;
    bsdf.coat = 1.0f;
    bsdf.eta = eta;
    bsdf.normalReflectance = Vec3(root * root);
    bsdf.transmission = transmission;
    return bsdf;
}

} // namespace

TEST_CASE("pane lanes: the light that passes is that of one ray at a time", "[shading]")
{
    Bsdf colored = pane(1.5f, Vec3(1.0f, 0.5f, 0.0f));
    colored.normalReflectance = Vec3(0.0f, 0.02f, 0.08f);
    colored.specular = 0.7f;
    Bsdf noInterface = pane(1.5f, Vec3(0.9f));
    noInterface.coat = 0.0f;
    for (const Bsdf& bsdf : {pane(1.5f, Vec3(1.0f)), pane(2.4f, Vec3(0.3f, 0.6f, 0.9f)),
                             pane(1.0001f, Vec3(1.0f)), colored, noInterface})
    {
        REQUIRE(isClearPane(bsdf));
        FloatLanes x, y, z;
        Vec3Lanes normal, share;
        for (int i = 0; i < kLanes; ++i)
        {
            const float cosine = static_cast<float>(i) / (kLanes - 1); // 0 to 1, both included
            x[i] = std::sqrt(1.0f - cosine * cosine);
            y[i] = 0.0f;
            z[i] = i % 2 ? cosine : -cosine;
            setLane(normal, i, Vec3(0, 0, 1));
        }
        clearPaneLanes(bsdf, {x, y, z, normal}, share);
        for (int i = 0; i < kLanes; ++i)
        {
            const Vec3 one = straightTransmittance(bsdf, std::fabs(z[i]));
            const Vec3 lane = laneOf(share, i);
            CAPTURE(bsdf.eta, z[i], one.x, one.y, one.z, lane.x, lane.y, lane.z);
            for (int c = 0; c < 3; ++c)
                CHECK(std::fabs(lane[c] - one[c]) <= 1e-6f);
        }
    }
}

TEST_CASE("pane lanes: panes with other layers, and what is no pane, are not theirs", "[shading]")
{
    const Bsdf clear = pane(1.5f, Vec3(1.0f));
    Bsdf film = clear, coat = clear, sheen = clear, rough = clear, body = clear, opaque = clear;
    film.film = 0.5f;
    coat.clearcoat = 0.5f;
    sheen.sheen = Vec3(0.0f, 0.1f, 0.0f);
    rough.alpha = 0.2f;
    body.thin = false;
    opaque.transmission = Vec3(0.0f);
    for (const Bsdf& bsdf : {film, coat, sheen, rough, body, opaque})
        CHECK_FALSE(isClearPane(bsdf));
}
