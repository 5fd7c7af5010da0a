// ShaderScenes.h - a triangle with the state that programs read, and its conversion by rules.
// Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include <osg/Image>
#include <osg/Program>
#include <osg/Texture2D>
#include <osg/Uniform>

#include <string>
#include <vector>

namespace osgRayTrace::test
{

/// Stands for osgEarth's class: a program that is no osg::Program.
class VirtualProgram : public osg::StateAttribute
{
public:
    VirtualProgram() = default;
    VirtualProgram(const VirtualProgram& other, const osg::CopyOp& copyop = osg::CopyOp())
        : osg::StateAttribute(other, copyop)
    {
    }
    META_StateAttribute(test, VirtualProgram, osg::StateAttribute::PROGRAM)
    int compare(const osg::StateAttribute& other) const override
    {
        return this == &other ? 0 : this < &other ? -1 : 1;
    }
};

/// Returns a texture of one texel, with the name of a file.
inline osg::ref_ptr<osg::Texture2D> texel(const std::vector<unsigned char>& rgba,
                                          const std::string& file = {})
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::copy(rgba.begin(), rgba.end(), image->data());
    image->setFileName(file);
    return new osg::Texture2D(image);
}

/// Holds a triangle "part" below a group "model". Its state has a program "Bump", textures without
/// modes and uniforms, as scenes for OpenGL's core profile have.
struct ShadedPart
{
    ShadedPart()
    {
        part->setName("part");
        part->setTexCoordArray(0, new osg::Vec2Array(3));
        model->setName("model");
        model->addChild(part);
        program->setName("Bump");
        program->addShader(new osg::Shader(osg::Shader::FRAGMENT, "void main() {}"));
        program->getShader(0)->setFileName("shaders/bump.frag");
        state().setAttribute(program);
    }

    osg::StateSet& state() { return *part->getOrCreateStateSet(); }

    /// Binds a texture without a mode; name: of the sampler, unless it is empty.
    void bind(unsigned int unit, osg::Texture* texture, const std::string& name = {})
    {
        state().setTextureAttribute(unit, texture);
        if (!name.empty()) state().addUniform(new osg::Uniform(name.c_str(), int(unit)));
    }

    engine::ConversionInput input(const std::string& text) const
    {
        engine::ConversionInput input = engine::inputFor(model);
        const auto read = engine::parseMaterialLibrary(text, "m.json");
        REQUIRE(read.error == "");
        input.materials = read.library;
        input.rasterizesRest = true;
        return input;
    }

    /// Converts as a viewer does, with these rules between the brackets of "shaders".
    engine::ConversionResult convert(const std::string& rules) const
    {
        engine::SceneConverter converter;
        return converter.convert(input("{ \"shaders\": [\n" + rules + "\n] }"));
    }

    osg::ref_ptr<osg::Geometry> part = engine::triangleGeometry();
    osg::ref_ptr<osg::Group> model = new osg::Group;
    osg::ref_ptr<osg::Program> program = new osg::Program;
};

/// Condition of a rule that fits the part.
const std::string kBump = "\"if\": { \"program\": \"Bump\" }";

/// Returns the material that a rule with these members gives the part.
inline engine::Material materialOf(const ShadedPart& shaded, const std::string& members)
{
    const engine::ConversionResult result = shaded.convert("{ " + kBump + ", " + members + " }");
    REQUIRE(result.scene->instances.size() == 1);
    CHECK(engine::countOf(result, "traced.by-rule") == 1);
    return engine::soleMaterial(result);
}

/// Returns the first texel of a texture of the scene.
inline std::vector<int> texelOf(const engine::ConversionResult& result, uint32_t texture)
{
    const engine::Texture& found = *result.scene->textures.at(texture);
    return std::vector<int>(found.bytes.begin(), found.bytes.begin() + 4);
}

} // namespace osgRayTrace::test
