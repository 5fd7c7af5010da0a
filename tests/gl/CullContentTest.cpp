// CullContentTest.cpp - what exists in cull traversals only is traced, or drawn by OSG. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "CullNodes.h"
#include "CullView.h"
#include "tests/Catch.h"

#include <osgRayTrace/RayIntersector>

#include <osg/BlendFunc>
#include <osg/Depth>
#include <osg/LOD>
#include <osg/Light>
#include <osg/Point>
#include <osg/Program>
#include <osg/Projection>
#include <osg/Switch>
#include <osg/Texture2D>
#include <osgUtil/SceneView>
#include <osgViewer/Renderer>

using namespace osgRayTrace;
using namespace osgRayTrace::test;
using namespace application;

namespace
{

void useEffectsOf(osg::Camera& camera)
{
    auto& renderer = dynamic_cast<osgViewer::Renderer&>(*camera.getRenderer());
    for (unsigned int i = 0; i < 2; ++i)
        renderer.getSceneView(i)->setCullVisitor(new EffectCullVisitor);
}

void useEffects(TestViewer& viewer)
{
    useEffectsOf(viewer.camera());
}

/// Adds a camera in a corner that sees other nodes by their masks.
void useEffectsAndMasks(TestViewer& viewer)
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setGraphicsContext(viewer.camera().getGraphicsContext());
    camera->setViewport(0, 0, 4, 4);
    camera->setRenderOrder(osg::Camera::POST_RENDER);
    camera->setCullMask(1);
    viewer.viewer.addSlave(camera.get());
    useEffectsOf(*camera);
    useEffects(viewer);
}

/// Returns a camera that fills a texture.
osg::ref_ptr<osg::Camera> textureCamera(osg::Texture2D& texture)
{
    texture.setTextureSize(64, 64);
    texture.setInternalFormat(GL_RGBA);
    texture.setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setRenderOrder(osg::Camera::PRE_RENDER);
    camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    camera->attach(osg::Camera::COLOR_BUFFER, &texture);
    camera->setViewport(0, 0, 64, 64);
    camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    camera->setProjectionMatrixAsOrtho2D(-1, 1, -1, 1);
    camera->setClearColor(kRed);
    camera->addChild(unlitSquare(0.5f, kBlue));
    return camera;
}

/// Counts its calls, and knows the material of one geometry.
struct CountingHook : MaterialHook
{
    osg::ref_ptr<PhysicalMaterial> materialFor(const osg::NodePath& path,
                                               const std::vector<const osg::StateSet*>&) override
    {
        ++calls;
        return path.back() == known ? material : nullptr;
    }

    int calls = 0;
    const osg::Node* known = nullptr;
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
};

} // namespace

TEST_CASE("cull content: drawables that only a cull traversal finds", "[gl][cull]")
{
    osg::ref_ptr<osg::Node> square = raised(unlitSquare(0.8f, kRed).get(), 0.5f);
    osg::ref_ptr<osg::Group> above = new osg::Group;
    osg::ref_ptr<CullDrawn> terrain = new CullDrawn(square.get());
    above->addChild(terrain.get());
    SECTION("opaque ones are traced")
    {
        View view(above.get());
        checkPicture(view);
        CHECK(view.count("converted.culled") == 1);
        CHECK(view.count("converted.instance") == 2);
        CHECK(view.count("rasterized.foreign-node") == 0);
    }
    SECTION("a program is drawn by OSG")
    {
        addProgram(*square);
        View view(above.get());
        checkPicture(view);
        CHECK(view.count("rasterized.foreign-node") == 1);
        CHECK(view.count("rasterized.shader-program") == 1);
    }
    SECTION("some of both, the traced ones are not drawn twice")
    {
        osg::ref_ptr<osg::Group> both = new osg::Group;
        both->addChild(square.get());
        osg::ref_ptr<osg::Node> other = raised(unlitSquare(0.4f, kBlue).get(), 0.9f);
        addProgram(*other);
        both->addChild(other.get());
        terrain->content = both.get();
        View view(above.get());
        checkPicture(view);
        CHECK(view.count("converted.culled") == 1);
        CHECK(view.count("rasterized.shader-program") == 1);
        square->setDataVariance(osg::Object::DYNAMIC);
        osg::ref_ptr<CountedDraws> counted = new CountedDraws;
        square->asGroup()->getChild(0)->asGeometry()->setDrawCallback(counted.get());
        view.viewer.frames(2);
        CHECK(counted->draws == 0);
    }
    SECTION("a texture that a camera among them renders")
    {
        osg::ref_ptr<osg::Group> both = new osg::Group;
        const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
        both->addChild(textureCamera(*texture).get());
        const osg::ref_ptr<osg::Geometry> screen = unlitSquare(0.8f, osg::Vec4(1, 1, 1, 1));
        screen->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture.get());
        both->addChild(raised(screen.get(), 0.5f));
        terrain->content = both.get();
        View view(above.get());
        checkPicture(view);
        CHECK(view.count("rasterized.texture-without-image") == 1);
        CHECK(view.count("rasterized.foreign-node") == 1);
    }
    SECTION("a drawable in two passes")
    {
        osg::ref_ptr<osg::Group> passes = new osg::Group;
        osg::ref_ptr<osg::Group> second = new osg::Group;
        second->getOrCreateStateSet()->setAttributeAndModes(new osg::BlendFunc(GL_ONE, GL_ONE));
        second->getStateSet()->setAttributeAndModes(new osg::Depth(osg::Depth::LEQUAL));
        second->addChild(square.get());
        passes->addChild(square.get());
        passes->addChild(second.get());
        terrain->content = passes.get();
        View view(above.get());
        checkPicture(view);
        CHECK(view.count("rasterized.several-passes") == 2);
    }
    SECTION("a hint has OSG draw the group as a whole")
    {
        RayTracedScene::setHint(above.get(), RayTracedScene::RASTERIZE);
        View view(above.get());
        checkPicture(view);
        CHECK(view.count("converted.culled") == 0);
        CHECK(view.count("converted.instance") == 1);
        view.viewer.frames(1);
        const uint64_t conversions = view.conversions();
        square->asTransform()->asMatrixTransform()->setMatrix(osg::Matrix::translate(0.4, 0, 0.5));
        view.viewer.frames(2);
        CHECK(view.conversions() == conversions);
        checkPicture(view);
    }
}

TEST_CASE("cull content: state that a callback pushes", "[gl][cull]")
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(raised(plainSquare(0.8f).get(), 0.5f));
    osg::ref_ptr<StatePusher> pusher = new StatePusher(unlitColor(kRed), unlitColor(kRed));
    group->setCullCallback(pusher.get());
    SECTION("a material is traced; state sets that take turns are no change")
    {
        View view(group.get());
        checkPicture(view);
        CHECK(view.count("converted.culled") == 1);
        view.viewer.frames(2);
        const uint64_t conversions = view.conversions();
        view.viewer.frames(5);
        CHECK(view.conversions() == conversions);
        pusher->states[0] = pusher->states[1] = unlitColor(kBlue);
        checkPicture(view);
        CHECK(view.conversions() == conversions);
    }
    SECTION("text and a program get it from OSG")
    {
        osg::ref_ptr<osg::Node> shaded = raised(plainSquare(0.5f).get(), 0.8f);
        addProgram(*shaded);
        group->addChild(shaded.get());
        View view(group.get());
        checkPicture(view);
        CHECK(view.count("rasterized.cull-callback") == 1);
        CHECK(view.count("converted.culled") == 1);
    }
    SECTION("what has a projection of its own is left to OSG")
    {
        const osg::ref_ptr<osg::Projection> projection =
            new osg::Projection(osg::Matrix::ortho2D(-2.0, 2.0, -2.0, 2.0));
        const osg::ref_ptr<osg::MatrixTransform> overlay = raised(plainSquare(0.8f).get(), 0.5f);
        overlay->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        projection->addChild(overlay.get());
        group->addChild(projection.get());
        View view(group.get());
        checkPicture(view);
        CHECK(view.count("not-traced.projection") == 1);
        CHECK(view.count("converted.culled") == 1);
    }
    SECTION("a light is left to OSG")
    {
        for (osg::ref_ptr<osg::StateSet>& state : pusher->states)
        {
            osg::ref_ptr<osg::Light> light = new osg::Light(3);
            light->setPosition(osg::Vec4(0, 0, 1, 0));
            light->setDiffuse(kBlue);
            state = new osg::StateSet;
            state->setAttributeAndModes(light.get());
            state->setMode(GL_LIGHTING, osg::StateAttribute::ON);
        }
        View view(group.get());
        checkPicture(view);
        CHECK(view.count("rasterized.pushed-light") == 1);
    }
}

TEST_CASE("cull content: a cull visitor of the application's", "[gl][cull]")
{
    osg::ref_ptr<EffectGeode> geode = new EffectGeode;
    geode->addDrawable(plainSquare(0.8f).get());
    geode->effect = unlitColor(kRed).get();
    const osg::ref_ptr<osg::MatrixTransform> content = raised(geode.get(), 0.5f);
    SECTION("its state is traced")
    {
        View view(content.get(), useEffects);
        checkPicture(view, useEffects);
        CHECK(view.count("converted.culled") == 1);
    }
    SECTION("what moves goes along")
    {
        const bool masked = GENERATE(false, true), inLevels = GENERATE(false, true);
        CAPTURE(masked, inLevels);
        const Setup setup = [masked](TestViewer& viewer)
        { masked ? useEffectsAndMasks(viewer) : useEffects(viewer); };
        const osg::ref_ptr<osg::LOD> levels = new osg::LOD; // GraphWatch does not look into it
        struct Animation : osg::Group                       // of a class of the application's
        {
        };
        levels->addChild(new Animation, 0.0f, 1e6f);
        levels->getChild(0)->asGroup()->addChild(content);
        const osg::ref_ptr<EffectGeode> lights = new EffectGeode; // OSG draws them
        lights->addDrawable(plainSquare(0.2f).get());
        lights->effect = new osg::StateSet;
        lights->effect->setAttributeAndModes(new osg::BlendFunc(GL_ONE, GL_ONE));
        const osg::ref_ptr<osg::Switch> flashing = new osg::Switch;
        flashing->setCullCallback(new StatePusher(unlitColor(kRed), unlitColor(kRed)));
        flashing->addChild(raised(lights.get(), 0.9f));
        flashing->addChild(new osg::Group, false);
        levels->getChild(0)->asGroup()->addChild(flashing);
        View view(inLevels ? levels.get() : content->asGroup(), setup);
        view.viewer.frames(3);
        content->setMatrix(osg::Matrix::translate(0.6, 0.1, 0.6));
        view.viewer.frames(2); // the values of arrays are known from here
        const uint64_t conversions = view.conversions();
        content->setMatrix(osg::Matrix::translate(0.7, 0.2, 0.6));
        lights->getOrCreateStateSet()->setAttribute(new osg::Point(2.0f));
        flashing->setValue(1, true);
        view.viewer.frames(1);
        CHECK(view.conversions() == conversions);
        checkPicture(view, setup);
    }
    SECTION("its program is drawn by OSG")
    {
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(new osg::Shader(
            osg::Shader::FRAGMENT, "void main() { gl_FragColor = vec4(0.1, 0.9, 0.9, 1.0); }"));
        geode->effect->setAttributeAndModes(program.get());
        View view(content.get(), useEffects);
        checkPicture(view, useEffects);
        CHECK(view.count("rasterized.foreign-node") == 1);
        CHECK(view.count("rasterized.shader-program") == 1);
    }
}

TEST_CASE("cull content: a transform that asks the cull visitor for its eye", "[gl][cull]")
{
    osg::ref_ptr<EyeFollower> follower = new EyeFollower;
    follower->setCullingActive(false); // its bound is where the eye is not
    SECTION("a surface is traced")
    {
        follower->addChild(raised(unlitSquare(0.4f, kRed).get(), -1.5f));
        View view(follower.get());
        checkPicture(view);
        CHECK(view.count("converted.culled") == 1);
        CHECK(view.count("rasterized.foreign-node") == 0);
    }
    SECTION("a sky, which its depth range puts behind the wall")
    {
        const osg::ref_ptr<osg::Geometry> sky = unlitSquare(2.0f, kRed);
        sky->getStateSet()->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 1.0, 1.0));
        sky->getStateSet()->setRenderBinDetails(-1, "RenderBin");
        follower->addChild(raised(sky.get(), -1.5f));
        View view(follower.get());
        checkPicture(view);
        CHECK(pixel(*view.viewer.frames(1), kViewSize / 2, kViewSize / 2).r() <
              60.0f); // the wall is green
        CHECK(view.count("rasterized.depth-range") == 1);
        CHECK(view.count("converted.culled") == 0);
    }
}

TEST_CASE("cull content: the application's material hook is asked in conversions only",
          "[gl][cull]")
{
    const osg::ref_ptr<osg::Geometry> plain = plainSquare(0.8f), shaded = plainSquare(0.4f);
    addProgram(*shaded);
    osg::ref_ptr<osg::Group> content = new osg::Group;
    content->addChild(raised(plain.get(), 0.5f));
    content->addChild(raised(shaded.get(), 0.9f));
    osg::ref_ptr<CullDrawn> terrain = new CullDrawn(content.get());
    View view(terrain.get());
    const osg::ref_ptr<CountingHook> hook = new CountingHook;
    hook->known = plain.get();
    view.scene->getSettings()->setMaterialHook(hook.get());
    view.viewer.frames(3);
    CHECK(view.count("converted.culled") == 1);
    CHECK(view.count("rasterized.shader-program") == 1);
    const uint64_t conversions = view.conversions();
    const int calls = hook->calls;
    view.viewer.frames(5);
    CHECK(view.conversions() == conversions);
    CHECK(hook->calls == calls);
    view.scene->dirtyScene();
    view.viewer.frames(1);
    CHECK(hook->calls == calls + 3); // once for each of the two squares and the wall

    const osg::ref_ptr<osg::Geometry> other = plainSquare(0.4f);
    addProgram(*other);
    hook->known = other.get();
    osg::ref_ptr<osg::Group> exchanged = new osg::Group;
    exchanged->addChild(raised(other.get(), 0.9f));
    exchanged->addChild(raised(shaded.get(), 0.5f));
    terrain->content = exchanged.get();
    view.viewer.frames(2);
    CHECK(view.count("converted.culled") == 1);
    CHECK(view.count("traced.by-rule") == 1); // the hook was asked for what is new
}

TEST_CASE("cull content: what only hides changes nothing", "[gl][cull]")
{
    const osg::ref_ptr<osg::Geometry> square = unlitSquare(0.3f, kRed);
    osg::ref_ptr<osg::Group> group = new osg::Group;
    std::vector<osg::ref_ptr<osg::MatrixTransform>> places;
    for (int i = 0; i < 3; ++i)
    {
        places.push_back(new osg::MatrixTransform(osg::Matrix::translate(0.7 * i, 0.0, 0.5)));
        places.back()->addChild(square.get());
        group->addChild(places.back().get());
    }
    bool hides = false;
    SECTION("a callback that traverses") {}
    SECTION("a callback that hides")
    {
        hides = true;
    }
    group->setCullCallback(new Passing(hides));
    View view(group.get());
    view.viewer.frames(2);
    CHECK(view.count("converted.instance") == 4);
    CHECK(view.count("converted.culled") == 0);
    CHECK(view.count("rasterized.cull-callback") == 0);
    const uint64_t conversions = view.conversions();
    places[1]->setMatrix(osg::Matrix::translate(0.7, 0.3, 0.5));
    view.viewer.frames(2);
    places[1]->setMatrix(osg::Matrix::translate(0.7, 0.4, 0.5));
    view.viewer.frames(2);
    CHECK(view.conversions() <=
          conversions + 1); // the first move may take it out of the static BVH
}

TEST_CASE("cull content: each node is judged alone", "[gl][cull]")
{
    osg::ref_ptr<osg::Group> outer = new osg::Group;
    outer->setCullCallback(new Passing(false));
    outer->addChild(raised(unlitSquare(0.3f, kBlue).get(), 0.6f));
    osg::ref_ptr<osg::Group> inner = new osg::Group;
    inner->addChild(raised(plainSquare(0.8f).get(), 0.5f));
    inner->setCullCallback(new StatePusher(unlitColor(kRed), unlitColor(kRed)));
    outer->addChild(inner.get());
    View view(outer.get());
    checkPicture(view);
    CHECK(view.count("converted.culled") == 1);
    CHECK(view.count("converted.instance") == 3);
}

TEST_CASE("cull content: what is traced is picked at its node", "[gl][cull]")
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    const osg::ref_ptr<osg::Geometry> square = plainSquare(0.8f);
    group->addChild(raised(square.get(), 0.5f));
    group->setCullCallback(new StatePusher(unlitColor(kRed), unlitColor(kRed)));
    View view(group.get());
    view.viewer.frames(2);
    CHECK(view.count("converted.culled") == 1);
    osg::ref_ptr<RayIntersector> ray =
        new RayIntersector(osg::Vec3d(0.1, 0.2, 5.0), osg::Vec3d(0.1, 0.2, -5.0));
    osgUtil::IntersectionVisitor picks(ray.get());
    view.scene->accept(picks);
    REQUIRE(ray->containsIntersections());
    CHECK(ray->getFirstIntersection().drawable == square);
    CHECK(ray->getFirstIntersection().getWorldIntersectPoint().z() == Approx(0.5));
}

TEST_CASE("cull content: a callback that throws is OSG's", "[gl][cull]")
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(raised(unlitSquare(0.8f, kRed).get(), 0.5f));
    osg::ref_ptr<Throwing> throwing = new Throwing;
    group->setCullCallback(throwing.get());
    View view(group.get());
    throwing->throws = 1; // in the cull traversal that nobody draws
    checkPicture(view);
    CHECK(view.count("warned.cull-exception") == 1);
    CHECK(view.count("rasterized.cull-callback") == 1);
}

TEST_CASE("cull content: an attribute of type program is a program", "[gl][cull]")
{
    const osg::ref_ptr<osg::MatrixTransform> square = raised(unlitSquare(0.8f, kRed).get(), 0.5f);
    square->getOrCreateStateSet()->setAttribute(new VirtualProgram);
    View view(square.get());
    checkPicture(view);
    CHECK(view.count("rasterized.shader-program") == 1);
    CHECK(view.count("converted.geometry") == 1);
    square->getStateSet()->setAttribute(new osg::Program); // one without shaders does nothing
    checkPicture(view);
    CHECK(view.count("rasterized.shader-program") == 0);
    CHECK(view.count("converted.geometry") == 2);
}
