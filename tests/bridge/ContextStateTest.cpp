// ContextStateTest.cpp - conversion asks nothing of OpenGL: a program of its own, which never has a
// context.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include <osgRayTrace/PhysicalMaterial>
#include <osgRayTrace/RayTracedScene>
#include <osgRayTrace/Renderer>

#include <osg/ContextData>
#include <osg/FrameStamp>
#include <osg/GLExtensions>
#include <osg/Texture1D>
#include <osg/Texture2D>
#include <osg/Texture2DArray>
#include <osg/Texture3D>
#include <osg/TextureCubeMap>
#include <osg/TextureRectangle>
#include <osgDB/ReadFile>
#include <osgText/Text>
#include <osgUtil/UpdateVisitor>

#include <string>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

constexpr unsigned int kContexts = 8;
constexpr int kFrames = 3;

/// Returns how many OpenGL contexts have state, although none of them exists.
unsigned int contextsWithState()
{
    unsigned int count = 0;
    for (unsigned int id = 0; id < kContexts; ++id)
        count += osg::GLExtensions::Get(id, false) || osg::getContextData(id);
    return count;
}

osg::ref_ptr<osg::Image> image(int layers = 1)
{
    osg::ref_ptr<osg::Image> result = new osg::Image;
    result->allocateImage(8, 8, layers, GL_RGBA, GL_UNSIGNED_BYTE);
    for (unsigned int i = 0; i < result->getTotalSizeInBytes(); ++i)
        result->data()[i] = static_cast<unsigned char>(i);
    return result;
}

/// Returns a texture of each class with an image, then one of each class without.
std::vector<osg::ref_ptr<osg::Texture>> textures()
{
    std::vector<osg::ref_ptr<osg::Texture>> all = {
        new osg::Texture1D,        new osg::Texture2D,      new osg::Texture3D,
        new osg::TextureRectangle, new osg::TextureCubeMap, new osg::Texture2DArray};
    const std::size_t classes = all.size();
    for (std::size_t i = 0; i < classes; ++i)
    {
        const osg::ref_ptr<osg::Texture> filled = osg::clone(all[i].get());
        for (unsigned int face = 0; face < (i == 4 ? 6u : 1u); ++face)
            filled->setImage(face, image(i == 2 ? 4 : 1).get());
        all.push_back(filled);
    }
    return all;
}

/// Returns a graph with every class of textures in every mode of formats.
osg::ref_ptr<osg::Group> graphOfTextures()
{
    using osg::Texture;
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    for (int mode = Texture::USE_IMAGE_DATA_FORMAT; mode <= Texture::USE_ETC2_COMPRESSION; ++mode)
        for (const osg::ref_ptr<Texture>& texture : textures())
        {
            texture->setInternalFormatMode(static_cast<Texture::InternalFormatMode>(mode));
            const osg::ref_ptr<osg::Geometry> geometry = triangleGeometry();
            geometry->setTexCoordArray(0, new osg::Vec2Array(3));
            for (unsigned int unit = 0; unit < 3; ++unit)
                geometry->getOrCreateStateSet()->setTextureAttributeAndModes(unit, texture);
            root->addChild(geometry);
            if (auto* flat = dynamic_cast<osg::Texture2D*>(texture.get()))
            {
                const osg::ref_ptr<osg::Geometry> physical = triangleGeometry();
                physical->setTexCoordArray(0, new osg::Vec2Array(3));
                const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
                material->setBaseColorTexture(flat);
                material->setMetallicRoughnessTexture(flat);
                physical->getOrCreateStateSet()->setAttribute(material);
                root->addChild(physical);
            }
        }
    return root;
}

/// Returns a graph of objects that draw with OpenGL in ways of their own.
osg::ref_ptr<osg::Group> graphOfOthers()
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setText("text");
    root->addChild(text);
    const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    camera->attach(osg::Camera::COLOR_BUFFER, new osg::Texture2D);
    camera->addChild(triangleGeometry());
    root->addChild(camera);
    const osg::ref_ptr<osg::Geometry> programmed = triangleGeometry();
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, "void main() {}"));
    programmed->getOrCreateStateSet()->setAttribute(program);
    programmed->setUseVertexBufferObjects(true);
    root->addChild(programmed);
    return root;
}

/// Converts the model as a viewer has it converted and without a viewer, and traces it.
void traceEachWay(osg::Node* model)
{
    convertGraph(model);
    ConversionInput input = inputFor(model);
    input.rasterizesRest = input.picks = true;
    SceneConverter().convert(input);

    const osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    scene->addChild(model);
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    osgUtil::UpdateVisitor update;
    update.setFrameStamp(stamp);
    for (int frame = 0; frame < kFrames; ++frame)
    {
        stamp->setFrameNumber(static_cast<unsigned int>(frame));
        stamp->setSimulationTime(0.1 * frame);
        update.setTraversalNumber(frame);
        scene->accept(update);
    }
    scene->releaseGLObjects();

    const osg::ref_ptr<Renderer> renderer = new Renderer;
    renderer->getSettings()->setMaxPasses(1);
    renderer->setScene(model);
    renderer->setSize(16, 12);
    renderer->setHomeView();
    CHECK(renderer->render());
}

} // namespace

TEST_CASE("conversion makes no state of an OpenGL context: textures of all classes and formats",
          "[bridge]")
{
    const osg::ref_ptr<osg::Group> graph = graphOfTextures();
    traceEachWay(graph);
    CHECK(contextsWithState() == 0);
    // Conversion does not write into the scene either.
    for (unsigned int i = 0; i < graph->getNumChildren(); ++i)
    {
        const osg::StateSet& state = *graph->getChild(i)->getStateSet();
        const auto* texture = dynamic_cast<const osg::Texture*>(
            state.getTextureAttribute(0, osg::StateAttribute::TEXTURE));
        if (texture) REQUIRE(texture->getInternalFormatType() == osg::Texture::NORMALIZED);
    }
}

TEST_CASE("conversion makes no state of an OpenGL context: text, cameras and programs", "[bridge]")
{
    traceEachWay(graphOfOthers());
    CHECK(contextsWithState() == 0);
}

TEST_CASE("conversion makes no state of an OpenGL context: sample models", "[osg-data]")
{
    const std::string name =
        GENERATE("axes.osgt", "cessna.osgt", "cessnafire.osgt", "clock.osgt", "cow.osgt",
                 "cube_mapped_torus.osgt", "dot3_bumpmapping.osgt", "dumptruck.osgt", "glider.osgt",
                 "glsl_simple.osgt", "lz.osgt", "morphing.osg", "nathan.osg", "simpleroom.osgt",
                 "SmokeBox.osgt");
    CAPTURE(name);
    const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(name);
    if (!model)
    {
        WARN("skipped: " << name << " is not in OSG_FILE_PATH");
        return;
    }
    REQUIRE(contextsWithState() == 0); // nor does reading make any state
    traceEachWay(model);
    CHECK(contextsWithState() == 0);
}
