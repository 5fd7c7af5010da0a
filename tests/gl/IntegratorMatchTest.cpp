// IntegratorMatchTest.cpp - classic materials reflect as much light, of the same hue, whether
// OpenGL, WHITTED or PATH computes it. Set OSG_FILE_PATH to OpenSceneGraph's sample models. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "MatchPictures.h"

#include <osg/LightModel>
#include <osg/Material>
#include <osg/Program>
#include <osgDB/ReadFile>

#include <algorithm>
#include <iomanip>
#include <string>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

/// Sets one directional light at the eye, which nothing in OpenGL clamps, and no ambient light: the
/// picture is what materials reflect.
void lightFromTheEye(TestViewer& view)
{
    osg::Light& light = *view.viewer.getLight();
    light.setAmbient({0.0f, 0.0f, 0.0f, 1.0f});
    light.setDiffuse({0.5f, 0.5f, 0.5f, 1.0f});
    light.setSpecular({0.5f, 0.5f, 0.5f, 1.0f});
}

using SceneMaker = std::function<osg::ref_ptr<osg::Node>()>;

/// Returns a new scene for each picture, because textures release their images to the context of a
/// picture.
osg::ref_ptr<osg::Node> lit(const SceneMaker& make)
{
    const osg::ref_ptr<osg::Node> node = make();
    if (!node) return nullptr;
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(node);
    osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity({0.0f, 0.0f, 0.0f, 1.0f});
    group->getOrCreateStateSet()->setAttribute(model);
    group->getOrCreateStateSet()->setMode(GL_NORMALIZE, osg::StateAttribute::ON);
    return group;
}

/// Returns the mean colour, 0 to 255, of the pixels that OpenGL covers. The background is black, so
/// its share in pixels at edges does not matter.
osg::Vec3d meanOf(const Picture& picture, const Picture& rasterized)
{
    osg::Vec3d sum;
    for (int y = 0; y < picture.color->t(); ++y)
        for (int x = 0; x < picture.color->s(); ++x)
        {
            const osg::Vec4 color = pixel(*picture.color, x, y);
            sum += osg::Vec3d(color.r(), color.g(), color.b());
        }
    const auto covered = std::count(rasterized.covered.begin(), rasterized.covered.end(), true);
    return sum / std::max(double(covered), 1.0);
}

double sumOf(const osg::Vec3d& color)
{
    return color.x() + color.y() + color.z();
}

/// Returns how far two colours are apart once they are equally bright, 0 to 255.
double hueDifference(const osg::Vec3d& color, const osg::Vec3d& other)
{
    const osg::Vec3d d = color - other * (sumOf(color) / std::max(sumOf(other), 1e-6));
    return std::max({std::fabs(d.x()), std::fabs(d.y()), std::fabs(d.z())});
}

struct Agreement
{
    double ratio; ///< PATH's or WHITTED's brightness over OpenGL's
    double hue;
};

struct Agreements
{
    Agreement whitted, path;
};

/// openGL: what OpenGL draws, if that is not the scene that is traced.
Agreements compareIntegrators(const std::string& name, const SceneMaker& make, MatchSetup setup,
                              const SceneMaker& openGL = {})
{
    setup.view = [view = setup.view](TestViewer& viewer)
    {
        lightFromTheEye(viewer);
        if (view) view(viewer);
    };
    const Picture rasterized = rasterize(lit(openGL ? openGL : make).get(), setup);
    const auto agreement = [&](RayTraceSettings::Integrator integrator)
    {
        setup.settings = [integrator](RayTraceSettings& settings)
        {
            settings.setIntegrator(integrator);
            settings.setMaxBounces(1); // OpenGL has no light from other surfaces
        };
        const Picture traced = rayTrace(lit(make).get(), setup);
        keepPictures(name + (integrator == RayTraceSettings::PATH ? "-path" : "-whitted"), traced,
                     rasterized);
        const osg::Vec3d ours = meanOf(traced, rasterized), theirs = meanOf(rasterized, rasterized);
        std::cout << "  " << (integrator == RayTraceSettings::PATH ? "PATH" : "WHITTED") << " ("
                  << ours.x() << ", " << ours.y() << ", " << ours.z() << ")";
        return Agreement{sumOf(ours) / sumOf(theirs), hueDifference(theirs, ours)};
    };
    const osg::Vec3d opengl = meanOf(rasterized, rasterized);
    std::cout << std::fixed << std::setprecision(1) << name << ": OpenGL (" << opengl.x() << ", "
              << opengl.y() << ", " << opengl.z() << ")";
    const Agreements agreements{agreement(RayTraceSettings::WHITTED),
                                agreement(RayTraceSettings::PATH)};
    std::cout << std::setprecision(3) << "; brightness over OpenGL's: WHITTED "
              << agreements.whitted.ratio << ", PATH " << agreements.path.ratio
              << "; difference of hue: WHITTED " << agreements.whitted.hue << ", PATH "
              << agreements.path.hue << std::endl;
    return agreements;
}

} // namespace

TEST_CASE("integrator match: highlights leave the diffuse colour alone", "[gl]")
{
    struct Surface
    {
        float diffuse; ///< times (1, 0.5, 0.2)
        float specular, shininess;
    };
    // Highlights of low exponent, as in the last two rows, are as bright as OpenGL's as long as no
    // more light is reflected than arrives.
    const Surface surface =
        GENERATE(Surface{0.7f, 0.0f, 0.0f}, Surface{0.7f, 0.2f, 5.0f}, Surface{0.7f, 0.5f, 12.5f},
                 Surface{0.8f, 1.0f, 40.0f}, Surface{0.9f, 1.0f, 128.0f}, Surface{0.4f, 0.2f, 1.0f},
                 Surface{0.4f, 0.1f, 0.0f});
    MatchSetup setup;
    setup.view = [](TestViewer& view)
    {
        view.camera().setProjectionMatrixAsPerspective(12.0, 120.0 / 90.0, 1.0, 100.0);
        view.look(osg::Vec3d(0.0, 0.0, 30.0));
    };
    const auto make = [&surface]() -> osg::ref_ptr<osg::Node>
    {
        osg::ref_ptr<osg::ShapeDrawable> ball = sphere(osg::Vec3(), 2.0f, osg::Vec4(1, 1, 1, 1));
        osg::ref_ptr<osg::Material> material = new osg::Material;
        const auto side = osg::Material::FRONT_AND_BACK;
        material->setDiffuse(side, osg::Vec4(osg::Vec3(1.0f, 0.5f, 0.2f) * surface.diffuse, 1.0f));
        material->setSpecular(side, {surface.specular, surface.specular, surface.specular, 1.0f});
        material->setShininess(side, surface.shininess);
        ball->getOrCreateStateSet()->setAttribute(material);
        return ball;
    };
    const std::string name = "ball-" + std::to_string(int(100.0f * surface.specular)) + "-" +
                             std::to_string(int(surface.shininess));
    const Agreements agreements = compareIntegrators(name, make, setup);
    CHECK(agreements.whitted.ratio == Approx(1.0).margin(0.02));
    CHECK(agreements.path.ratio == Approx(1.0).margin(0.03));
    CHECK(agreements.path.hue < 2.0);
}

TEST_CASE("integrator match: sample models are as bright and of the same hue", "[gl][osg-data]")
{
    struct Model
    {
        std::string name;
        double path = 1.0, margin = 0.05; ///< brightness of PATH over OpenGL's
        double hue = 2.0, whitted = 0.05;
    };
    // The normals of axes.osgt's arrowheads look to their back: PATH lights the side that is seen.
    // OpenGL lights the cessna's coarse noses by vertex. The cow of chrome would reflect up to
    // twice the light that arrives. The cases below look at the last two. SmokeBox.osgt,
    // cessnafire.osgt, clock.osgt, dot3_bumpmapping.osgt and morphing.osg are left out, because
    // they depend on the clock.
    const Model tested =
        GENERATE(Model{"axes.osgt", 1.08, 0.02}, Model{"cessna.osgt", 1.05, 0.02, 2.0, 0.06},
                 Model{"cow.osgt", 0.78, 0.02, 3.0}, Model{"cube_mapped_torus.osgt"},
                 Model{"dumptruck.osgt"}, Model{"glider.osgt"}, Model{"glsl_simple.osgt"},
                 Model{"lz.osgt"}, Model{"nathan.osg"}, Model{"simpleroom.osgt"});
    const auto make = [&tested] { return osgDB::readRefNodeFile(tested.name); };
    if (!make())
    {
        WARN("skipped: " << tested.name << " is not in OSG_FILE_PATH");
        return;
    }
    MatchSetup setup;
    setup.width = 320;
    setup.height = 240;
    setup.homeView = true;
    const Agreements agreements = compareIntegrators(tested.name, make, setup);
    CAPTURE(tested.name);
    CHECK(agreements.whitted.ratio == Approx(1.0).margin(tested.whitted));
    CHECK(agreements.whitted.hue < 2.0);
    CHECK(agreements.path.ratio == Approx(tested.path).margin(tested.margin));
    CHECK(agreements.path.hue < tested.hue);
}

TEST_CASE("integrator match: each term of the cow's is OpenGL's, their sum where it is below 1",
          "[gl][osg-data]")
{
    struct Terms
    {
        float diffuse, specular;
        bool osgviewersLight; ///< in which OpenGL clamps the sum to 1 before it is textured
        double path, margin;  ///< brightness of PATH over OpenGL's
    };
    const Terms terms =
        GENERATE(Terms{1.0f, 0.0f, false, 1.0, 0.01}, Terms{0.0f, 1.0f, false, 1.0, 0.01},
                 Terms{0.5f, 0.5f, false, 1.0, 0.01}, Terms{1.0f, 1.0f, false, 0.78, 0.02},
                 Terms{1.0f, 1.0f, true, 1.035, 0.015});
    const auto make = [&terms]
    {
        osg::ref_ptr<osg::Node> cow = osgDB::readRefNodeFile("cow.osgt");
        if (!cow) return cow;
        osg::ref_ptr<osg::Material> material = new osg::Material;
        const auto side = osg::Material::FRONT_AND_BACK;
        material->setDiffuse(side, {terms.diffuse, terms.diffuse, terms.diffuse, 1.0f});
        material->setSpecular(side, {terms.specular, terms.specular, terms.specular, 1.0f});
        material->setShininess(side, 1.0f); // the cow's own
        cow->getOrCreateStateSet()->setAttribute(material, osg::StateAttribute::OVERRIDE);
        return cow;
    };
    if (!make())
    {
        WARN("skipped: cow.osgt is not in OSG_FILE_PATH");
        return;
    }
    MatchSetup setup;
    setup.homeView = true;
    if (terms.osgviewersLight)
        setup.view = [](TestViewer& view)
        {
            view.viewer.getLight()->setDiffuse({0.8f, 0.8f, 0.8f, 1.0f});
            view.viewer.getLight()->setSpecular({1.0f, 1.0f, 1.0f, 1.0f});
        };
    const Agreements agreements = compareIntegrators("cow-terms", make, setup);
    CAPTURE(terms.diffuse, terms.specular, terms.osgviewersLight);
    CHECK(agreements.path.ratio == Approx(terms.path).margin(terms.margin));
}

TEST_CASE("integrator match: the cessna is as bright as OpenGL's, were it lit by pixel",
          "[gl][osg-data]")
{
    const auto make = [] { return osgDB::readRefNodeFile("cessna.osgt"); };
    if (!make())
    {
        WARN("skipped: cessna.osgt is not in OSG_FILE_PATH");
        return;
    }
    const auto byPixel = [&make]
    {
        const osg::ref_ptr<osg::Node> cessna = make();
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(new osg::Shader(osg::Shader::VERTEX, R"(
            varying vec3 normal;
            void main()
            {
                normal = gl_NormalMatrix * gl_Normal;
                gl_FrontColor = gl_Color;
                gl_Position = ftransform();
            })"));
        program->addShader(new osg::Shader(osg::Shader::FRAGMENT, R"(
            varying vec3 normal;
            void main() // light at the eye, and a material without highlights
            {
                float cosine = max(normalize(normal).z, 0.0);
                gl_FragColor = vec4(gl_Color.rgb * gl_LightSource[0].diffuse.rgb * cosine, 1.0);
            })"));
        cessna->getOrCreateStateSet()->setAttribute(program);
        return cessna;
    };
    MatchSetup setup;
    setup.width = 320;
    setup.height = 240;
    setup.homeView = true;
    const Agreements agreements = compareIntegrators("cessna-by-pixel", make, setup, byPixel);
    CHECK(agreements.whitted.ratio == Approx(1.0).margin(0.01));
    CHECK(agreements.path.ratio == Approx(1.0).margin(0.01));
}
