// FogMatchTest.cpp - fog looks as OpenGL draws it. Layer: tests.
// SPDX-License-Identifier: MIT
#include "StateScenes.h"

#include <osg/BlendFunc>
#include <osg/Fog>
#include <osg/LightModel>
#include <osg/Material>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

/// TestViewer's eye is 10 above the plane z = 0.
osg::ref_ptr<osg::Fog> fogOf(osg::Fog::Mode mode)
{
    osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setMode(mode);
    fog->setColor({0.9f, 0.6f, 0.3f, 1.0f});
    fog->setDensity(mode == osg::Fog::EXP ? 0.08f : 0.09f);
    fog->setStart(4.0f);
    fog->setEnd(20.0f);
    return fog;
}

void setFog(osg::Node& node, osg::Fog* fog)
{
    node.getOrCreateStateSet()->setAttributeAndModes(fog, kOn);
}

/// Returns lit, unlit, textured and blended squares that lean away from the eye, at all depths.
osg::ref_ptr<osg::Group> leaningSquares()
{
    const auto at = [](double x, double y, double z, double angle, osg::Node* node)
    {
        return placed(osg::Matrixd::rotate(angle, osg::Vec3d(1, 0, 0)) *
                          osg::Matrixd::translate(x, y, z),
                      node);
    };
    const osg::ref_ptr<osg::Geometry> textured = square(1.5f, {1, 1, 1, 1}, 2.0f);
    textured->getOrCreateStateSet()->setTextureAttributeAndModes(0,
                                                                 textureOf(patchwork(8, GL_RGB)));
    const osg::ref_ptr<osg::Geometry> pane = unlit(square(1.2f, {0.1f, 0.9f, 0.2f, 0.5f}));
    pane->getOrCreateStateSet()->setAttributeAndModes(new osg::BlendFunc, kOn);
    pane->getOrCreateStateSet()->setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    return groupOf({at(-2.5, 1.0, 0.0, -1.0, unlit(square(1.5f, {0.2f, 0.3f, 0.9f, 1.0f}))),
                    at(1.0, 1.0, -3.0, -1.2, textured),
                    at(3.5, 0.0, -8.0, -0.8, square(3.0f, {0.9f, 0.2f, 0.8f, 1.0f})),
                    at(-1.0, -1.5, -6.0, -0.3, square(1.7f, {0.3f, 0.8f, 0.8f, 1.0f})),
                    at(-0.5, -1.0, 2.0, -0.6, pane)});
}

} // namespace

TEST_CASE("match: fog of all modes over all kinds of surfaces", "[gl][coverage]")
{
    for (const auto& [name, mode] : {std::pair("fog-linear", osg::Fog::LINEAR),
                                     {"fog-exp", osg::Fog::EXP},
                                     {"fog-exp2", osg::Fog::EXP2}})
    {
        const osg::ref_ptr<osg::Group> root = leaningSquares();
        setFog(*root, fogOf(mode));
        Statistics statistics;
        CHECK(matches(name, root, {}, &statistics));
        for (const auto& [what, count] : statistics.conversion)
            CHECK_FALSE(what.find("fog") != std::string::npos);
    }
}

TEST_CASE("match: each surface has the fog of its own state, or none", "[gl][coverage]")
{
    const osg::ref_ptr<osg::Group> root = leaningSquares();
    setFog(*root->getChild(0), fogOf(osg::Fog::LINEAR));
    setFog(*root->getChild(1), fogOf(osg::Fog::EXP2));
    const osg::ref_ptr<osg::Fog> thick = fogOf(osg::Fog::EXP);
    thick->setDensity(0.3f);
    setFog(*root->getChild(3), thick);
    root->getChild(4)->getOrCreateStateSet()->setMode(GL_FOG, kOn); // OpenGL's first values: black
    CHECK(matches("fog-each", root));
}

TEST_CASE("match: fog in a view whose axis is not in its middle", "[gl][coverage]")
{
    const osg::ref_ptr<osg::Group> root = leaningSquares();
    setFog(*root, fogOf(osg::Fog::LINEAR));
    MatchSetup setup;
    setup.view = [](TestViewer& view)
    { view.camera().setProjectionMatrixAsFrustum(-0.2, 0.9, -0.5, 0.3, 1.0, 100.0); };
    CHECK(matches("fog-off-axis", root, setup));
    setup.view = [](TestViewer& view)
    { view.camera().setProjectionMatrixAsOrtho(-5.0, 5.0, -4.0, 3.5, 1.0, 100.0); };
    CHECK(matches("fog-parallel", root, setup));
}

TEST_CASE("match: the path tracer shows the fog of what is unlit as OpenGL does", "[gl][coverage]")
{
    const osg::ref_ptr<osg::Group> root = leaningSquares();
    root->removeChild(root->getChild(4)); // blended: rays pass by chance, with noise
    root->getOrCreateStateSet()->setMode(GL_LIGHTING, kOff | osg::StateAttribute::OVERRIDE);
    setFog(*root, fogOf(osg::Fog::EXP));
    MatchSetup setup;
    setup.settings = [](RayTraceSettings& settings)
    { settings.setIntegrator(RayTraceSettings::PATH); };
    CHECK(matches("fog-path", root, setup));
}
