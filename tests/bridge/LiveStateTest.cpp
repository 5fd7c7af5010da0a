// LiveStateTest.cpp - edits of state, and of effects of state that depend on places. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osg/AlphaFunc>
#include <osg/BlendFunc>
#include <osg/ClipNode>
#include <osg/CullFace>
#include <osg/Fog>
#include <osg/FrontFace>
#include <osg/Geometry>
#include <osg/LightModel>
#include <osg/PolygonOffset>
#include <osg/TexEnv>
#include <osg/TexGen>
#include <osg/TexGenNode>
#include <osg/TexMat>

#include <functional>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

/// Returns a picture with edges in each direction, no two alike, and with transparent texels.
osg::ref_ptr<osg::Image> pattern()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int t = 0; t < 4; ++t)
        for (int s = 0; s < 4; ++s)
        {
            unsigned char* texel = image->data(s, t);
            texel[0] = static_cast<unsigned char>(60 * s + 40);
            texel[1] = static_cast<unsigned char>(200 - 60 * t);
            texel[2] = static_cast<unsigned char>(s == t ? 250 : 90);
            texel[3] = static_cast<unsigned char>((s + t) % 2 ? 255 : 60);
        }
    return image;
}

/// Extends the live graph by all kinds of traced state on its first tile, whose values have little
/// effect.
struct StateGraph : LiveGraph
{
    StateGraph()
    {
        root->addChild(texGenNode);
        geometry(0).setTexCoordArray(
            1, static_cast<osg::Array*>(
                   geometry(0).getTexCoordArray(0)->clone(osg::CopyOp::DEEP_COPY_ALL)));
        for (int unit = 0; unit < 2; ++unit)
        {
            textures[unit] = new osg::Texture2D(pattern());
            textures[unit]->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
            textures[unit]->setResizeNonPowerOfTwoHint(false);
            state->setTextureAttributeAndModes(unit, textures[unit]);
            state->setTextureAttribute(unit, environments[unit]);
            state->setTextureAttribute(unit, matrices[unit]);
        }
        state->setAttributeAndModes(alpha);
        state->setAttributeAndModes(cull, osg::StateAttribute::OFF);
        state->setAttribute(front);
        state->setAttribute(blend);
        state->setAttributeAndModes(offset, osg::StateAttribute::OFF);
        state->setAttribute(model);
        alpha->setFunction(osg::AlphaFunc::ALWAYS);
        materials[0]->setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(0.8f, 0.8f, 0.8f, 1));
        materials[0]->setShininess(osg::Material::FRONT_AND_BACK, 8.0f);
        materials[0]->setDiffuse(osg::Material::FRONT, osg::Vec4(0.6f, 0.8f, 0.9f, 1.0f));
        materials[0]->setDiffuse(osg::Material::BACK, osg::Vec4(0.9f, 0.2f, 0.1f, 1.0f));
        deform(0, 0.15f);
    }

    void generate(osg::TexGen::Mode mode)
    {
        texGen->setMode(mode);
        texGen->setPlane(osg::TexGen::S, osg::Plane(1.0, 0.0, 0.0, 0.0));
        texGen->setPlane(osg::TexGen::T, osg::Plane(0.0, 1.0, 0.0, 0.0));
        state->setTextureAttributeAndModes(0, texGen);
    }

    osg::ref_ptr<osg::StateSet> state = objects[0]->getStateSet();
    osg::ref_ptr<osg::Texture2D> textures[2];
    osg::ref_ptr<osg::TexEnv> environments[2] = {new osg::TexEnv, new osg::TexEnv};
    osg::ref_ptr<osg::TexMat> matrices[2] = {new osg::TexMat, new osg::TexMat};
    osg::ref_ptr<osg::TexGen> texGen = new osg::TexGen;
    osg::ref_ptr<osg::TexGenNode> texGenNode = new osg::TexGenNode;
    osg::ref_ptr<osg::AlphaFunc> alpha = new osg::AlphaFunc;
    osg::ref_ptr<osg::BlendFunc> blend = new osg::BlendFunc;
    osg::ref_ptr<osg::CullFace> cull = new osg::CullFace;
    osg::ref_ptr<osg::FrontFace> front = new osg::FrontFace;
    osg::ref_ptr<osg::PolygonOffset> offset = new osg::PolygonOffset;
    osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
};

/// Makes edits one after the other. Each edit must be visible, and look as in a fresh conversion.
class Watched
{
public:
    explicit Watched(StateGraph& graph) : _graph(graph), _view(graph.root.get())
    {
        _view.update();
        _last = _view.image();
    }

    void edit(const char* what, const std::function<void()>& change, bool shows = true)
    {
        INFO(what);
        change();
        const Statistics before = _view.statistics();
        _view.update();
        CHECK(_view.statistics().ok);
        const std::vector<float> image = _view.image();
        const int different = differentPixels(image, freshImage(*_graph.root, _view.passes()));
        CHECK(different >= 0);
        CHECK(different <= kRoundedPixels);
        if (shows)
        {
            CHECK(differentPixels(image, _last) > kRoundedPixels);
        }
        CHECK(_view.statistics().conversions + _view.statistics().patches >
              before.conversions + before.patches);
        _last = image;
    }

    void move(const char* what, const osg::Matrixd& matrix)
    {
        edit(what, [&] { _graph.objects[0]->setMatrix(matrix); });
    }

private:
    StateGraph& _graph;
    LiveView _view;
    std::vector<float> _last;
};

osg::Matrixd at(double x, double y)
{
    return osg::Matrixd::translate(x, y, 0.3);
}

constexpr auto kOn = osg::StateAttribute::ON;

} // namespace

TEST_CASE("live state: mips of textures that are small in the picture", "[bridge]")
{
    StateGraph graph;
    auto& uvs = static_cast<osg::Vec2Array&>(*graph.geometry(0).getTexCoordArray(0));
    for (osg::Vec2& uv : uvs)
        uv *= 40.0f;
    Watched watched(graph);
    osg::Texture2D& texture = *graph.textures[0];
    watched.edit("none",
                 [&] { texture.setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR); });
    watched.edit(
        "blended",
        [&] { texture.setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR); });
}

TEST_CASE("live state: fog", "[bridge]")
{
    StateGraph graph;
    osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setDensity(0.05f);
    fog->setColor({0.9f, 0.1f, 0.9f, 1.0f});
    Watched watched(graph);
    watched.edit("on", [&] { graph.state->setAttributeAndModes(fog); });
    watched.edit("density", [&] { fog->setDensity(0.1f); });
    watched.edit("mode", [&] { fog->setMode(osg::Fog::EXP2); });
    watched.edit("colour", [&] { fog->setColor({0.1f, 0.9f, 0.1f, 1.0f}); });
    watched.edit("radial", [&] { fog->setUseRadialFog(true); });
    watched.edit("linear", [&] { fog->setMode(osg::Fog::LINEAR); });
    watched.edit("end", [&] { fog->setEnd(30.0f); });
    watched.edit("start", [&] { fog->setStart(-40.0f); });
    watched.edit("off", [&] { graph.state->setMode(GL_FOG, osg::StateAttribute::OFF); });
}

TEST_CASE("live state: texture units", "[bridge]")
{
    StateGraph graph;
    Watched watched(graph);
    for (int unit = 0; unit < 2; ++unit)
    {
        CAPTURE(unit);
        osg::Texture2D& texture = *graph.textures[unit];
        watched.edit("matrix",
                     [&] { graph.matrices[unit]->setMatrix(osg::Matrixd::scale(1.7, 1.3, 1.0)); });
        watched.edit("wrap",
                     [&] { texture.setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_BORDER); });
        watched.edit("border", [&] { texture.setBorderColor(osg::Vec4d(0.9, 0.1, 0.4, 1.0)); });
        watched.edit("filter",
                     [&] { texture.setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR); });
        watched.edit("environment", [&] { graph.environments[unit]->setMode(osg::TexEnv::BLEND); });
        watched.edit("environment's colour", [&]
                     { graph.environments[unit]->setColor(osg::Vec4(0.9f, 0.4f, 0.0f, 1.0f)); });
        watched.edit("coordinates",
                     [&]
                     {
                         auto& uvs = static_cast<osg::Vec2Array&>(
                             *graph.geometry(0).getTexCoordArray(unsigned(unit)));
                         for (osg::Vec2& uv : uvs)
                             uv *= 1.9f;
                         uvs.dirty();
                     });
        watched.edit("image",
                     [&]
                     {
                         osg::Image& image = *texture.getImage();
                         for (int i = 0; i < 4; ++i)
                             image.data(i, 1)[1] = 255;
                         image.dirty();
                     });
        watched.edit("internal format",
                     [&]
                     {
                         graph.environments[unit]->setMode(osg::TexEnv::DECAL);
                         texture.setInternalFormat(GL_RGB);
                     });
        watched.edit("internal format again", [&] { texture.setInternalFormat(GL_RGBA); });
    }
}

TEST_CASE("live state: opacity and faces", "[bridge]")
{
    StateGraph graph;
    Watched watched(graph);
    // The first round is made while nothing moves, the second one while the tile has a BVH of its
    // own.
    for (int round = 0; round < 2; ++round)
    {
        CAPTURE(round);
        watched.edit(
            "alpha function", [&] { graph.alpha->setFunction(osg::AlphaFunc::GREATER); }, false);
        watched.edit("alpha reference", [&] { graph.alpha->setReferenceValue(0.5f); });
        watched.edit("no alpha test", [&] { graph.alpha->setFunction(osg::AlphaFunc::ALWAYS); });
        watched.edit("blending", [&] { graph.state->setMode(GL_BLEND, kOn); });
        watched.edit("factors", [&] { graph.blend->setFunction(GL_ONE, GL_ZERO); });
        graph.state->setMode(GL_BLEND, osg::StateAttribute::OFF);
        graph.blend->setFunction(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        watched.edit("culling off front",
                     [&]
                     {
                         graph.cull->setMode(osg::CullFace::FRONT);
                         graph.state->setMode(GL_CULL_FACE, kOn);
                     });
        watched.edit("culling back", [&] { graph.cull->setMode(osg::CullFace::BACK); });
        watched.edit("winding", [&] { graph.front->setMode(osg::FrontFace::CLOCKWISE); });
        watched.move("mirrored", osg::Matrixd::scale(-1.0, 1.0, 1.0) * at(1.2, 0.3));
        watched.move("moved on", osg::Matrixd::scale(-1.0, 1.0, 1.0) * at(1.5, 0.5));
        watched.move("mirrored back", at(0.3, 0.3));
        watched.edit("winding back",
                     [&] { graph.front->setMode(osg::FrontFace::COUNTER_CLOCKWISE); });
        watched.edit("deformed", [&] { graph.deform(0, 0.1f); });
        watched.edit("filtered and deformed at once",
                     [&]
                     {
                         graph.state->setMode(GL_CULL_FACE, osg::StateAttribute::OFF);
                         graph.state->setMode(GL_BLEND, kOn);
                         graph.deform(0, 0.12f);
                     });
        watched.edit("deformed again", [&] { graph.deform(0, 0.2f); });
        graph.state->setMode(GL_BLEND, osg::StateAttribute::OFF);
        graph.alpha->setReferenceValue(0.0f);
    }
}

TEST_CASE("live state: BVHs that were built for opaque surfaces", "[bridge]")
{
    StateGraph graph;
    Watched watched(graph);
    const auto pierce = [&]
    {
        graph.alpha->setReferenceValue(0.5f);
        graph.alpha->setFunction(osg::AlphaFunc::GREATER);
    };
    SECTION("of a tile that has moved")
    {
        watched.move("moved", at(0.1, 0.1));
        watched.move("moved on", at(0.2, 0.1));
        watched.edit("alpha test", pierce);
    }
    SECTION("of a tile that deforms")
    {
        for (int i = 0; i < 4; ++i)
            watched.edit("deformed", [&] { graph.deform(0, 0.05f + 0.05f * float(i)); });
        watched.edit("alpha test while it deforms",
                     [&]
                     {
                         pierce();
                         graph.deform(0, 0.18f);
                     });
        watched.edit("deformed on", [&] { graph.deform(0, 0.1f); });
    }
    SECTION("of tiles that are still beside one that moves")
    {
        watched.edit("another moved", [&] { graph.objects[5]->setMatrix(at(2.1, 0.7)); });
        watched.edit("alpha test", pierce);
        watched.edit("another moved on", [&] { graph.objects[5]->setMatrix(at(1.9, 0.6)); });
    }
}

TEST_CASE("live state: light model and two sides", "[bridge]")
{
    StateGraph graph;
    Watched watched(graph);
    watched.edit("separate highlights",
                 [&] { graph.model->setColorControl(osg::LightModel::SEPARATE_SPECULAR_COLOR); });
    watched.edit("local viewer", [&] { graph.model->setLocalViewer(true); });
    watched.edit("ambient",
                 [&] { graph.model->setAmbientIntensity(osg::Vec4(0.6f, 0.5f, 0.4f, 1)); });
    watched.edit("two sides, seen from behind",
                 [&]
                 {
                     graph.model->setTwoSided(true);
                     graph.front->setMode(osg::FrontFace::CLOCKWISE);
                 });
    watched.edit("back colours",
                 [&]
                 {
                     graph.materials[0]->setAmbient(
                         osg::Material::BACK, // the tile's back faces the light
                         osg::Vec4(0.1f, 0.9f, 0.1f, 1.0f));
                 });
    watched.move("moved", at(0.3, 0.3));
    watched.move("mirrored", osg::Matrixd::scale(-1.0, 1.0, 1.0) * at(1.2, 0.3));
}

TEST_CASE("live state: generated coordinates", "[bridge]")
{
    StateGraph graph;
    Watched watched(graph);
    for (const auto mode : {osg::TexGen::OBJECT_LINEAR, osg::TexGen::EYE_LINEAR})
    {
        CAPTURE(mode);
        watched.edit(
            "own", [&] { graph.generate(mode); }, mode == osg::TexGen::OBJECT_LINEAR);
        watched.edit("plane", [&]
                     { graph.texGen->setPlane(osg::TexGen::S, osg::Plane(2.3, 0.4, 0.0, 0.1)); });
        watched.move("moved", at(0.2, 0.2) * osg::Matrixd::rotate(0.1, 0.0, 0.0, 1.0));
        watched.move("moved on", at(0.4, 0.3) * osg::Matrixd::rotate(0.2, 0.0, 0.0, 1.0));
        watched.edit("deformed", [&] { graph.deform(0, 0.05f); });
        watched.edit("moved and deformed",
                     [&]
                     {
                         graph.deform(0, 0.15f);
                         graph.objects[0]->setMatrix(at(0.1, 0.0));
                     });
    }
    graph.state->removeTextureAttribute(0, osg::StateAttribute::TEXGEN);
    graph.state->setTextureMode(0, GL_TEXTURE_GEN_S, kOn);
    graph.state->setTextureMode(0, GL_TEXTURE_GEN_T, kOn);
    osg::TexGen& placed = *graph.texGenNode->getTexGen();
    watched.edit("placed", [&] { placed.setMode(osg::TexGen::EYE_LINEAR); });
    watched.edit("plane", [&] { placed.setPlane(osg::TexGen::S, osg::Plane(1.3, 0.9, 0.0, 0.1)); });
    watched.move("moved", at(0.5, 0.3));
    watched.move("moved on", at(0.7, 0.3));
    watched.edit("mode", [&] { placed.setMode(osg::TexGen::SPHERE_MAP); });
    watched.move("chrome moved", at(0.5, 0.3));
    watched.edit("chrome deformed", [&] { graph.deform(0, 0.1f); });
}

TEST_CASE("live state: raised faces", "[bridge]")
{
    StateGraph graph;
    // The tile lies in the plane of another one: the offset alone decides which of them is visible.
    graph.objects[1]->setMatrix(at(0.3, 0.2));
    graph.objects[0]->setMatrix(at(0.0, 0.0));
    graph.deform(0, 0.0f);
    graph.offset->setFactor(-2.0f);
    graph.offset->setUnits(-2.0f);
    graph.state->setMode(GL_POLYGON_OFFSET_FILL, kOn);
    Watched watched(graph);
    watched.edit("lowered", [&] { graph.offset->setUnits(2.0f); });
    watched.edit("raised", [&] { graph.offset->setUnits(-3.0f); });
    for (int i = 1; i < 6; ++i)
        watched.move("moved", at(0.05 * i, 0.03 * i));
    watched.edit(
        "raised more", [&] { graph.offset->setUnits(-4.0f); }, false);
    watched.move("moved after a conversion", at(0.1, 0.1));
    watched.move("moved back", at(0.0, 0.1));
    watched.edit("deformed", [&] { graph.deform(0, 0.05f); });
    watched.edit("flat again", [&] { graph.deform(0, 0.0f); });
    watched.move("moved again", at(0.1, 0.2));
}

TEST_CASE("live state: a clip plane of any number over tiles that are elsewhere", "[bridge]")
{
    StateGraph graph;
    osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
    clip->addClipPlane(new osg::ClipPlane(3, osg::Plane(-1.0, 0.0, 0.0, 0.5)));
    graph.root->addChild(clip);
    graph.state->setMode(GL_CLIP_PLANE0 + 3, kOn);
    Watched watched(graph);
    watched.move("moved", at(0.1, 0.2));
    watched.move("moved on", at(0.2, 0.3));
    watched.edit("plane", [&] { clip->getClipPlane(0)->setClipPlane(-1.0, 0.0, 0.0, 0.3); });
    watched.edit("deformed", [&] { graph.deform(0, 0.05f); });
}
