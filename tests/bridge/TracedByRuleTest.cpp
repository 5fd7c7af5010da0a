// TracedByRuleTest.cpp - what rules, names, materials and the application's hook have traced, and
// what of it is watched.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/bridge/changes/GraphWatch.h"
#include "osgRayTrace/bridge/graph/StatesAbove.h"
#include "tests/Catch.h"
#include "tests/bridge/Messages.h"
#include "tests/bridge/ShaderScenes.h"

#include <osgRayTrace/PhysicalMaterial>
#include <osgRayTrace/RayTracedScene>

#include <osg/BlendFunc>
#include <osg/TexEnvCombine>

#include <stdexcept>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;
using osgRayTrace::engine::test::Messages;

TEST_CASE("shader rules: a rule wins over programs and combiners, but not over hints or blending",
          "[bridge]")
{
    ShadedPart shaded;
    const std::string rule = "{ " + kBump + R"(, "roughness": 0.5 })";
    const std::string other = R"({ "if": { "program": "Wood" } })";
    CHECK(countOf(shaded.convert(other), "rasterized.shader-program") == 1);
    const ConversionResult traced = shaded.convert(rule);
    CHECK(countOf(traced, "converted.geometry") == 1);
    CHECK(countOf(traced, "rasterized.shader-program") == 0);
    CHECK(countOf(traced, "approximated.shader") == 0);

    shaded.state().setTextureAttributeAndModes(0, texel({1, 2, 3, 4}));
    shaded.state().setTextureAttribute(0, new osg::TexEnvCombine);
    CHECK(countOf(shaded.convert(rule), "traced.by-rule") == 1);

    RayTracedScene::setHint(shaded.part, RayTracedScene::RASTERIZE);
    CHECK(countOf(shaded.convert(rule), "rasterized.hint") == 1);
    RayTracedScene::setHint(shaded.part, RayTracedScene::AUTOMATIC);

    // The light of a flame is added, whatever its surface is.
    shaded.state().setAttributeAndModes(new osg::BlendFunc(GL_SRC_ALPHA, GL_ONE));
    const ConversionResult flame = shaded.convert(rule);
    CHECK(countOf(flame, "rasterized.additive-blending") == 1);
    CHECK(countOf(flame, "traced.by-rule") == 0);
}

TEST_CASE("shader rules: a texture that only OpenGL has stays with OpenGL", "[bridge]")
{
    ShadedPart shaded;
    osg::ref_ptr<osg::Texture2D> rendered = new osg::Texture2D;
    rendered->setTextureSize(16, 16);
    shaded.bind(4, rendered, "screen");
    const ConversionResult result =
        shaded.convert("{ " + kBump + R"(, "baseColorTexture": { "sampler": "screen" } })");
    CHECK(countOf(result, "rasterized.texture-without-image") == 1);
}

TEST_CASE("shader rules: a name or a physical material beside a program means: trace it",
          "[bridge]")
{
    ShadedPart shaded;
    SceneConverter converter;
    const auto convert = [&](const std::string& text)
    { return converter.convert(shaded.input(text)); };
    CHECK(countOf(convert("{}"), "rasterized.shader-program") == 1);
    const ConversionResult named = convert(R"({ "nodes": { "part": { "roughness": 0.5 } } })");
    CHECK(soleMaterial(named).roughness == 0.5f);
    CHECK(named.paths.at("traced.by-rule") == std::vector<std::string>{"'part', for model/part"});
    CHECK(countOf(convert(R"({ "nodes": { "model": { "roughness": 0.5 } } })"), "traced.by-rule") ==
          1);

    osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    material->setRoughness(0.125f);
    shaded.state().setAttribute(material);
    const ConversionResult beside = convert("{}");
    CHECK(soleMaterial(beside).roughness == 0.125f);
    CHECK(countOf(beside, "approximated.shader") == 0);

    // A program that is nearer than the material, such as that of a sky, draws as before.
    shaded.state().removeAttribute(material);
    shaded.model->getOrCreateStateSet()->setAttribute(material);
    CHECK(countOf(convert("{}"), "rasterized.shader-program") == 1);
    shaded.model->getStateSet()->setAttribute(material, osg::StateAttribute::OVERRIDE);
    CHECK(countOf(convert("{}"), "rasterized.shader-program") == 1);
    shaded.state().setAttribute(material); // the same material, now beside it
    CHECK(countOf(convert("{}"), "converted.geometry") == 1);
    ConversionInput without = shaded.input("{}");
    without.rasterizesRest = false;
    shaded.state().removeAttribute(material);
    CHECK(countOf(converter.convert(without), "approximated.shader") == 1);
}

TEST_CASE("shader rules: rules that fit nothing are named together", "[bridge]")
{
    ShadedPart shaded;
    CHECK(countOf(shaded.convert(R"({ "if": { "unit": 7 } }, { "if": { "unit": 8 } })"),
                  "warned.material-name") == 1);
    CHECK(countOf(shaded.convert("{ \"if\": { \"unit\": 7 } }, { " + kBump + " }"),
                  "warned.material-name") == 0);
}

TEST_CASE("shader rules: uniforms and textures are inherited as attributes are", "[bridge]")
{
    ShadedPart shaded;
    osg::StateSet& above = *shaded.model->getOrCreateStateSet();
    above.addUniform(new osg::Uniform("r", 0.25f));
    const std::string rule = R"("roughness": { "uniform": "r" })";
    CHECK(materialOf(shaded, rule).roughness == 0.25f);
    shaded.state().addUniform(new osg::Uniform("r", 0.5f));
    CHECK(materialOf(shaded, rule).roughness == 0.5f);
    above.addUniform(new osg::Uniform("r", 0.25f), osg::StateAttribute::OVERRIDE);
    CHECK(materialOf(shaded, rule).roughness == 0.25f);
    shaded.state().addUniform(new osg::Uniform("r", 0.5f), osg::StateAttribute::PROTECTED);
    CHECK(materialOf(shaded, rule).roughness == 0.5f);
}

TEST_CASE("shader rules: states hold what programs read only if a file has such rules", "[bridge]")
{
    const ShadedPart shaded;
    const auto follows = [&](const std::string& text)
    { return statesAbove(shaded.input(text)).states().front().shader != nullptr; };
    CHECK_FALSE(follows("{}"));
    CHECK_FALSE(follows(R"({ "nodes": { "part": {} }, "shaders": [] })"));
    CHECK(follows(R"({ "shaders": [ { "if": { "unit": 0 } } ] })"));
}

TEST_CASE("shader rules: changes of what rules read are noticed, others are not", "[bridge]")
{
    ShadedPart shaded;
    osg::ref_ptr<osg::Uniform> gloss = new osg::Uniform("gloss", 0.25f);
    osg::ref_ptr<osg::Uniform> time = new osg::Uniform("osg_FrameTime", 0.0f);
    shaded.state().addUniform(gloss);
    shaded.model->getOrCreateStateSet()->addUniform(time);
    shaded.state().setUserValue("IOR", 1.5);
    ViewingConditions conditions;
    const auto changed = [&](GraphWatch& watch)
    { return !watch.look(*shaded.model, conditions).none(); };

    GraphWatch plain;
    plain.record(*shaded.model, conditions);
    gloss->set(0.5f);
    CHECK_FALSE(changed(plain)); // nobody reads uniforms
    const uint64_t hash = graphHash(*shaded.model, conditions);
    shaded.state().addUniform(new osg::Uniform("other", 1.0f));
    CHECK_FALSE(changed(plain));
    CHECK(graphHash(*shaded.model, conditions) == hash);

    conditions.reads = shaded
                           .input(R"({ "shaders": [ { "if": { "user": "*" },
                                       "roughness": { "uniform": "gl*" } } ] })")
                           .materials->reads;
    GraphWatch watch;
    watch.record(*shaded.model, conditions);
    CHECK_FALSE(changed(watch));
    time->set(1.0f); // no rule reads the time of the frame
    CHECK_FALSE(changed(watch));
    gloss->set(0.5f); // the same value
    CHECK_FALSE(changed(watch));
    const uint64_t before = graphHash(*shaded.model, conditions);
    gloss->set(0.75f);
    CHECK(graphHash(*shaded.model, conditions) != before);
    CHECK(changed(watch));
    CHECK_FALSE(changed(watch));
    shaded.state().setUserValue("IOR", 1.25);
    CHECK(changed(watch));
    shaded.model->getStateSet()->addUniform(new osg::Uniform("panes", true));
    CHECK(changed(watch)); // conditions ask which uniforms there are
}

TEST_CASE("material hook: the application's answer wins, and its exceptions are none", "[bridge]")
{
    struct Hook : MaterialHook
    {
        osg::ref_ptr<PhysicalMaterial>
        materialFor(const osg::NodePath& path,
                    const std::vector<const osg::StateSet*>& states) override
        {
            names = path.front()->getName() + "/" + path.back()->getName();
            count = states.size();
            if (throws) throw std::runtime_error("the hook has no idea");
            return material;
        }
        std::string names;
        std::size_t count = 0;
        bool throws = false;
        osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    };
    ShadedPart shaded;
    const osg::ref_ptr<Hook> hook = new Hook;
    hook->material->setRoughness(0.375f);
    ConversionInput input = shaded.input(R"({ "nodes": { "part": { "roughness": 0.5 } } })");
    input.hook = hook;
    input.inheritedState = {new osg::StateSet};
    SceneConverter converter;
    const ConversionResult result = converter.convert(input);
    CHECK(soleMaterial(result).roughness == 0.375f);
    CHECK(result.paths.at("traced.by-rule") ==
          std::vector<std::string>{"'material hook', for model/part"});
    CHECK(hook->names == "model/part");
    CHECK(hook->count == 2); // the inherited one and the part's

    const Messages messages;
    hook->throws = true;
    CHECK(soleMaterial(converter.convert(input)).roughness == 0.5f);
    CHECK(messages.timesSaid("material hook: the hook has no idea, taken as no material") == 1);
    hook->throws = false;
    hook->material = nullptr;
    input.materials = nullptr;
    CHECK(countOf(converter.convert(input), "rasterized.shader-program") == 1);
}

TEST_CASE("material hook: is asked once for a geometry that OSG draws beside its proxy", "[bridge]")
{
    struct Hook : MaterialHook
    {
        osg::ref_ptr<PhysicalMaterial>
        materialFor(const osg::NodePath&, const std::vector<const osg::StateSet*>&) override
        {
            ++calls;
            return nullptr;
        }
        int calls = 0;
    };
    const ShadedPart shaded;
    const osg::ref_ptr<Hook> hook = new Hook;
    ConversionInput input = shaded.input("{}");
    input.hook = hook;
    SceneConverter converter;
    CHECK(countOf(converter.convert(input), "traced.proxy") == 1);
    CHECK(hook->calls == 1);
}

TEST_CASE("shader rules: vertex attributes that rules name are watched beside fixed arrays",
          "[bridge]")
{
    ShadedPart shaded;
    const osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(3);
    shaded.part->setVertexAttribArray(3, normals, osg::Array::BIND_PER_VERTEX);
    ViewingConditions conditions;
    const auto changed = [&](GraphWatch& watch)
    { return !watch.look(*shaded.model, conditions).none(); };
    const auto turn = [&](osg::Vec3Array& array)
    {
        array[0].z() += 1.0f;
        array.dirty();
    };

    GraphWatch plain;
    plain.record(*shaded.model, conditions);
    turn(*normals);
    CHECK_FALSE(changed(plain)); // nobody reads attributes

    const std::string rule = R"({ "shaders": [ { "if": { "program": "Bump" }, "attributes": )";
    conditions.reads = shaded.input(rule + R"({ "normal": 3 } } ] })").materials->reads;
    GraphWatch watch;
    watch.record(*shaded.model, conditions);
    CHECK_FALSE(changed(watch));
    turn(*normals);
    CHECK(changed(watch));
    CHECK_FALSE(changed(watch));
    const osg::ref_ptr<osg::Vec3Array> others = new osg::Vec3Array(3);
    shaded.part->setVertexAttribArray(3, others, osg::Array::BIND_PER_VERTEX);
    CHECK(changed(watch));
    turn(*others);
    CHECK(changed(watch));
    CHECK_FALSE(changed(watch));
}
