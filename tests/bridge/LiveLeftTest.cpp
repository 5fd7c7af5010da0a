// LiveLeftTest.cpp - state that changes where OSG draws converts nothing. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osg/BlendFunc>
#include <osg/Depth>
#include <osg/Program>
#include <osg/TexEnvCombine>
#include <osg/TexMat>

#include <cmath>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

constexpr int kCloud = 5, kSolid = 4;

/// Extends the live graph by a layer of clouds, as flight simulators have it: blended, with
/// textures that are combined, and with a texture matrix and a colour that are others each frame.
struct CloudGraph : LiveGraph
{
    CloudGraph()
    {
        state->setTextureAttributeAndModes(0, texture);
        state->setTextureAttributeAndModes(1, texture);
        state->setTextureAttribute(1, combination);
        state->setAttributeAndModes(new osg::BlendFunc);
        combination->setCombine_RGB(osg::TexEnvCombine::INTERPOLATE);
    }

    void drift(int frame)
    {
        const float along = 0.01f * float(frame);
        state->setTextureAttribute(0, new osg::TexMat(osg::Matrix::translate(along, 0.0f, 0.0f)));
        combination = new osg::TexEnvCombine(*combination);
        combination->setConstantColor(osg::Vec4(along, along, along, 1.0f));
        state->setTextureAttribute(1, combination);
    }

    osg::ref_ptr<osg::StateSet> state = objects[kCloud]->getOrCreateStateSet();
    osg::ref_ptr<osg::TexEnvCombine> combination = new osg::TexEnvCombine;
};

uint64_t countOf(const LiveView& view, const char* what)
{
    const auto counts = view.statistics().conversion;
    const auto found = counts.find(what);
    return found == counts.end() ? 0 : found->second;
}

/// Returns the materials of the scene that camera rays pass, and other rays do not.
std::vector<Material> proxyMaterials(const LiveView& view)
{
    std::vector<Material> materials;
    for (const Instance& instance : view.scene()->instances)
    {
        const Material& material = view.scene()->materials[instance.material];
        if (material.culling == FaceCulling::FrontAndBack) materials.push_back(material);
    }
    return materials;
}

} // namespace

TEST_CASE("left to OSG: state that changes in each frame converts nothing", "[bridge]")
{
    CloudGraph graph;
    LiveView view(graph.root);
    REQUIRE(countOf(view, "rasterized.texture-combine") == 1);
    REQUIRE(countOf(view, "traced.proxy") == 0);
    const Scene* const scene = view.scene();
    for (int frame = 0; frame < 20; ++frame)
    {
        graph.drift(frame);
        view.update();
        CAPTURE(view.statistics().lastConversionReason);
        REQUIRE(view.statistics().conversions == 1);
    }
    CHECK(view.scene() == scene); // so the picture goes on as well
    CHECK(view.statistics().patches == 20);
}

TEST_CASE("left to OSG: state that decides who draws is followed", "[bridge]")
{
    CloudGraph graph;
    LiveView view(graph.root);
    const auto convertsTo = [&](const char* reason, uint64_t proxies, bool left = true)
    {
        INFO(reason);
        const uint64_t before = view.statistics().conversions;
        CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
        CHECK(view.statistics().conversions == before + 1);
        CHECK(countOf(view, reason) == (left ? 1 : 0));
        CHECK(countOf(view, "traced.proxy") == proxies);
        graph.drift(int(before)); // the decision of the last conversion is what counts
        view.update();
        if (proxies == 0 && left) CHECK(view.statistics().conversions == before + 1);
    };
    const osg::ref_ptr<osg::BlendFunc> blend = new osg::BlendFunc;
    graph.state->setAttributeAndModes(blend, osg::StateAttribute::OFF);
    convertsTo("rasterized.texture-combine", 1); // opaque now: it casts a shadow
    const osg::ref_ptr<osg::Depth> depth = new osg::Depth;
    depth->setWriteMask(false);
    graph.state->setAttribute(depth);
    convertsTo("rasterized.texture-combine", 0);
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, "void main() {}"));
    graph.state->setAttributeAndModes(program);
    convertsTo("rasterized.shader-program", 0);
    graph.state->removeAttribute(program);
    convertsTo("rasterized.texture-combine", 0);
    graph.state->removeTextureAttribute(1, graph.combination);
    convertsTo("rasterized.texture-combine", 0, false); // traced
}

TEST_CASE("left to OSG: a proxy takes another material alone", "[bridge]")
{
    LiveGraph graph;
    osg::StateSet& state = *graph.objects[kSolid]->getStateSet();
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, "void main() {}"));
    state.setAttributeAndModes(program);
    LiveView view(graph.root);
    REQUIRE(proxyMaterials(view).size() == 1);
    for (int frame = 1; frame <= 3; ++frame)
    {
        const osg::ref_ptr<osg::Material> material = new osg::Material;
        const float red = 0.25f * float(frame);
        material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(red, 0.5f, 0.5f, 1.0f));
        state.setAttributeAndModes(material);
        CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
        const std::vector<Material> proxies = proxyMaterials(view);
        REQUIRE(proxies.size() == 1);
        LiveView fresh(graph.root);
        REQUIRE(proxyMaterials(fresh).size() == 1);
        CHECK(proxies[0].diffuse == proxyMaterials(fresh)[0].diffuse);
        CHECK(proxies[0].diffuse.x > 0.0f);
        CHECK(view.statistics().conversions == 1);
        CHECK(countOf(view, "traced.proxy") == 1);
    }
    graph.objects[kSolid]->setMatrix(osg::Matrixd::translate(0.4, 0.3, 1.0));
    CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    CHECK(view.statistics().conversions == 1);
}
