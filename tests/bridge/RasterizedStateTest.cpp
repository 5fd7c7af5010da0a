// RasterizedStateTest.cpp - state that leaves its geometry to OpenGL: textures that only OpenGL
// has, programs, stencils, colour masks, depth ranges.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/TexturedGraphs.h"

#include <osg/ColorMask>
#include <osg/Depth>
#include <osg/FragmentProgram>
#include <osg/LogicOp>
#include <osg/PolygonStipple>
#include <osg/Program>
#include <osg/Stencil>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

constexpr auto kOn = osg::StateAttribute::ON;

/// Converts as for a viewer, which draws the rest with OpenGL.
ConversionResult convertForViewer(SceneConverter& converter, osg::Node* root)
{
    ConversionInput input = inputFor(root);
    input.rasterizesRest = true;
    return converter.convert(input);
}

ConversionResult convertForViewer(osg::Node* root)
{
    SceneConverter converter;
    return convertForViewer(converter, root);
}

struct Filler : osg::Texture2D::SubloadCallback
{
    void load(const osg::Texture2D&, osg::State&) const override {}
    void subload(const osg::Texture2D&, osg::State&) const override {}
};

} // namespace

TEST_CASE("textures that only OpenGL has leave their geometry to it", "[bridge]")
{
    const char* const reason = "rasterized.texture-without-image";
    const auto rendered = []
    {
        const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
        texture->setTextureSize(64, 64);
        texture->setInternalFormat(GL_RGBA);
        return texture;
    };
    SECTION("a camera's")
    {
        const auto root = texturedGeometry(rendered());
        const ConversionResult result = convertForViewer(root);
        CHECK(countOf(result, reason) == 1);
        CHECK(result.rasterized);
        CHECK(countOf(result, "converted.geometry") == 0);
        CHECK(countOf(convertGraph(root), "approximated.texture-without-image") == 1);
    }
    SECTION("in unit 1, too; not if it is off, or the file of an image is missing")
    {
        const auto root = texturedGeometry(smallTexture());
        root->getStateSet()->setTextureAttributeAndModes(1, rendered(), kOn);
        CHECK(countOf(convertForViewer(root), reason) == 1);
        root->getStateSet()->setTextureMode(1, GL_TEXTURE_2D, osg::StateAttribute::OFF);
        CHECK(countOf(convertForViewer(root), reason) == 0);
        CHECK(convertForViewer(texturedGeometry(new osg::Texture2D)).scene->instances.size() == 1);
    }
    SECTION("what a callback fills")
    {
        const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
        texture->setSubloadCallback(new Filler);
        CHECK(countOf(convertForViewer(texturedGeometry(texture)), reason) == 1);
    }
    SECTION("not what was converted before its image was given up")
    {
        const auto texture = smallTexture();
        const auto root = texturedGeometry(texture);
        SceneConverter converter;
        convertForViewer(converter, root);
        texture->setImage(nullptr);
        texture->setTextureSize(1, 1); // as OSG records it on upload
        const ConversionResult result = convertForViewer(converter, root);
        CHECK(countOf(result, reason) == 0);
        CHECK(soleMaterial(result).baseColorTexture == 0);
        CHECK(countOf(convertForViewer(root), reason) == 1);
    }
}

namespace
{

/// A program of another class, as virtual programs are: it holds shaders in a way of its own.
struct VirtualProgram : osg::Program
{
    META_StateAttribute(test, VirtualProgram, PROGRAM)
    VirtualProgram() = default;
    VirtualProgram(const VirtualProgram& other, const osg::CopyOp& copy) : osg::Program(other, copy)
    {
    }
};

struct OtherProgram : osg::StateAttribute
{
    META_StateAttribute(test, OtherProgram, PROGRAM)
    OtherProgram() = default;
    OtherProgram(const OtherProgram& other, const osg::CopyOp& copy)
        : osg::StateAttribute(other, copy)
    {
    }
    int compare(const osg::StateAttribute& other) const override { return &other == this ? 0 : 1; }
};

} // namespace

TEST_CASE("programs of any class, stencils, masks and the like leave their geometry to OpenGL",
          "[bridge]")
{
    const auto counted = [](const osg::ref_ptr<osg::Geometry>& geometry, const std::string& what)
    {
        const ConversionResult result = convertForViewer(geometry);
        CHECK((countOf(result, "converted.geometry") == 1) ==
              (countOf(result, "rasterized." + what) == 0));
        return countOf(result, "rasterized." + what);
    };
    const auto geometry = triangleGeometry();
    osg::StateSet& state = *geometry->getOrCreateStateSet();
    SECTION("programs")
    {
        CHECK(counted(geometry, "shader-program") == 0);
        state.setAttribute(new osg::Program); // without shaders: the fixed function
        CHECK(counted(geometry, "shader-program") == 0);
        state.setAttribute(new VirtualProgram);
        CHECK(counted(geometry, "shader-program") == 1);
        CHECK(countOf(convertGraph(geometry), "approximated.shader") == 1);
        state.setAttribute(new OtherProgram);
        CHECK(counted(geometry, "shader-program") == 1);
    }
    SECTION("ARB's programs")
    {
        state.setAttribute(new osg::FragmentProgram);
        CHECK(counted(geometry, "shader-program") == 0); // the mode is off
        state.setMode(GL_FRAGMENT_PROGRAM_ARB, kOn);
        CHECK(counted(geometry, "shader-program") == 1);
    }
    SECTION("stencil")
    {
        state.setAttribute(new osg::Stencil);
        CHECK(counted(geometry, "stencil") == 0);
        state.setMode(GL_STENCIL_TEST, kOn);
        CHECK(counted(geometry, "stencil") == 1);
        CHECK(countOf(convertGraph(geometry), "approximated.stencil") == 1);
    }
    SECTION("colour mask")
    {
        const osg::ref_ptr<osg::ColorMask> mask = new osg::ColorMask(true, true, true, false);
        state.setAttribute(mask);
        CHECK(counted(geometry, "color-mask") == 0);
        mask->setMask(true, false, true, true);
        CHECK(counted(geometry, "color-mask") == 1);
        CHECK(countOf(convertGraph(geometry), "approximated.color-mask") == 1);
    }
    SECTION("a depth range without extent")
    {
        const osg::ref_ptr<osg::Depth> depth = new osg::Depth(osg::Depth::LEQUAL, 0.5, 1.0);
        state.setAttributeAndModes(depth);
        CHECK(counted(geometry, "depth-range") == 0);
        depth->setRange(1.0, 1.0);
        CHECK(counted(geometry, "depth-range") == 1);
        CHECK(countOf(convertForViewer(geometry), "traced.proxy") == 0);
        CHECK(countOf(convertGraph(geometry), "approximated.depth-range") == 1);
    }
    SECTION("logic operations and stipples")
    {
        CHECK(counted(geometry, "logic-operation") == 0);
        state.setAttributeAndModes(new osg::LogicOp(osg::LogicOp::COPY_INVERTED));
        CHECK(counted(geometry, "logic-operation") == 1);
        CHECK(countOf(convertGraph(geometry), "approximated.logic-operation") == 1);
        state.setMode(GL_COLOR_LOGIC_OP, osg::StateAttribute::OFF);
        state.setAttributeAndModes(new osg::PolygonStipple);
        CHECK(counted(geometry, "polygon-stipple") == 1);
        CHECK(countOf(convertGraph(geometry), "approximated.polygon-stipple") == 1);
    }
    SECTION("not those above the scene, which hold for its picture")
    {
        const osg::ref_ptr<osg::StateSet> above = new osg::StateSet;
        above->setAttributeAndModes(new osg::Stencil, kOn | osg::StateAttribute::OVERRIDE);
        above->setAttribute(new osg::ColorMask(true, false, false, true));
        above->setAttribute(new osg::Depth(osg::Depth::ALWAYS, 1.0, 1.0));
        ConversionInput input = inputFor(geometry);
        input.rasterizesRest = true;
        input.inheritedState = {above};
        CHECK(SceneConverter().convert(input).scene->instances.size() == 1);
    }
}
