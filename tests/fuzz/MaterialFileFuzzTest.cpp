// MaterialFileFuzzTest.cpp - damaged material files give a library with values in range, or an
// error that names the place. Layer: tests.
// SPDX-License-Identifier: MIT
#include "FuzzSeeds.h"
#include "tests/Catch.h"

#include "osgRayTrace/bridge/appearance/materials/MaterialLibrary.h"

#include <cctype>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

constexpr int kFiles = 20000; ///< seeds

const std::string kValid = R"({
  "nodes": {
    "cow*": { "baseColor": [1, 1, 1], "transmission": 1, "roughness": 0, "ior": 1.5 },
    "*": { "metallic": 0.5 }
  },
  "materials": { "lamp": { "emission": [20, 18.5, 1e1] }, "caf\u00e9": {} },
  "textures": { "wood.png": { "roughness": 0.3 } },
  "shaders": [
    { "name": "bump", "if": { "program": "Bump*", "sampler": ["diffuseMap", "n*"] },
      "baseColorTexture": { "sampler": "diffuseMap", "srgb": true },
      "roughness": { "uniform": "gloss", "invert": true, "scale": 0.5, "optional": true },
      "metallicRoughnessTexture": { "unit": 3, "channels": "ga" },
      "attributes": { "position": 0, "texcoord": 8 } },
    { "if": { "unit": 0, "user": "sDiffuse", "texture": "*_n.png" }, "baseColor": [1, 0.5, 0],
      "roughnessTexture": { "user": "s" }, "alphaReference": 0.5 }
  ]
}
)";

const char* const kPieces[] = {"{",
                               "}",
                               "[",
                               "]",
                               "\"",
                               ",",
                               ":",
                               "null",
                               "true",
                               "1e999",
                               "-1",
                               "nan",
                               "\\u",
                               "\\ud8",
                               "\xff",
                               "\n",
                               "1e-400",
                               "[[[[[[[[",
                               "\"a\"",
                               "{\"nodes\":{",
                               "\"roughness\":",
                               "0.5",
                               "\xef\xbb\xbf",
                               "//",
                               "{\"shaders\":[{\"if\":{",
                               "\"if\":",
                               "\"channels\":",
                               "{\"uniform\":"};

std::string damaged(Dice& dice)
{
    std::string text = kValid;
    const int edits = 1 + dice.below(4);
    for (int i = 0; i < edits && !text.empty(); ++i)
    {
        const auto at = static_cast<std::size_t>(dice.below(static_cast<int>(text.size())));
        switch (dice.below(5))
        {
        case 0:
            text[at] = static_cast<char>(dice.below(256));
            break;
        case 1:
            text.erase(at, static_cast<std::size_t>(1 + dice.below(12)));
            break;
        case 2:
            text.insert(at, dice.oneOf(kPieces));
            break;
        case 3:
            text.insert(at, text.substr(at, static_cast<std::size_t>(1 + dice.below(60))));
            break;
        default:
            if (dice.oneIn(4)) text.resize(at);
        }
    }
    return text;
}

bool isIn(float value, float low, float high)
{
    return value >= low && value <= high;
}

void checkRules(const MaterialRuleList& rules)
{
    for (const MaterialRule& rule : rules)
    {
        const PhysicalMaterial& m = *rule.material;
        bool good = !rule.pattern.empty() && isIn(m.getMetallic(), 0, 1) &&
                    isIn(m.getRoughness(), 0, 1) && isIn(m.getTransmission(), 0, 1) &&
                    isIn(m.getIor(), 1, 4);
        for (int c = 0; c < 3; ++c)
            good = good && isIn(m.getBaseColor()[c], 0, 1) && isIn(m.getEmission()[c], 0, 1e30f);
        CHECK(good);
        rules.find("cow.osg");
    }
}

void checkShaders(const MaterialLibrary& library)
{
    bool good = (library.reads != nullptr) == !library.shaders.empty();
    for (const ShaderRule& rule : library.shaders)
    {
        good = good && !rule.name.empty() && !rule.conditions.empty();
        for (const ParameterRule& item : rule.parameters)
        {
            const bool constant = item.source.kind == ValueSource::Kind::Constant;
            good = good && item.parameter &&
                   item.source.constant.size() == (constant ? item.parameter->count : 0) &&
                   item.source.pattern.empty() == constant;
            for (const double value : item.source.constant)
                good = good && value >= item.parameter->lowest && value <= item.parameter->highest;
        }
        for (unsigned int field = 0; field < kTextureFields; ++field)
        {
            if (!rule.textures[field]) continue;
            const TextureSource& source = *rule.textures[field];
            const std::size_t letters = field == kMetallicRoughnessField ? 2
                                        : field <= kEmissionField        ? 0
                                                                         : 1;
            good = good && source.channels.size() == letters &&
                   source.channels.find_first_not_of("rgba") == std::string::npos;
        }
    }
    CHECK(good);
}

} // namespace

TEST_CASE("fuzz: damaged material files", "[fuzz]")
{
    int good = 0, bad = 0;
    const auto test = [&](uint32_t seed)
    {
        Dice dice(seed);
        const std::string text = damaged(dice);
        const MaterialLibraryResult result = parseMaterialLibrary(text, "m.json");
        if (result.library)
        {
            ++good;
            checkRules(result.library->nodes);
            checkRules(result.library->materials);
            checkRules(result.library->textures);
            checkShaders(*result.library);
            return;
        }
        ++bad;
        CAPTURE(seed, text, result.error);
        CHECK(result.error.rfind("m.json:", 0) == 0);
        const bool placed = result.error.find("line ") != std::string::npos ||
                            (result.error.size() > 7 && std::isdigit(result.error[7]));
        CHECK(placed);
    };
    forEachSeed(kFiles, test);
    CHECK(20 * good > good + bad);
    CHECK(2 * bad > good + bad);
}
