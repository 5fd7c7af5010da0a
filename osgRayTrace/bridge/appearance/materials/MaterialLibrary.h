// MaterialLibrary.h - gives physical materials to models that have none, by names. Layer: bridge.
// SPDX-License-Identifier: MIT
//
// A library is a JSON file:
//   { "nodes":     { "windscreen": { "transmission": 1, "roughness": 0, "baseColor": [1, 1, 1] } },
//     "materials": { "chrome*":    { "metallic": 1, "roughness": 0.05 } },
//     "textures":  { "wood.png":   { "roughness": 0.3 } },
//     "shaders":   [ { "if": { "program": "Bump*" }, "baseColorTexture": { "unit": 0 } } ] }
// The names are those of nodes (the nearest one above or at the geometry), of the osg::Material
// that the geometry is drawn with, and of the image file of its texture, with or without folders.
// An entry with "edits": 1 changes the model's material instead of taking its place. "*" stands for
// any characters. A node's entry wins over a material's, and a material's over a
// texture's. In each group a name wins over a pattern, and the first of several patterns wins.
// The parameters are those of PhysicalMaterial; without baseColor the diffuse colour and the
// texture of the model stay. ShaderRule.h has the rules of the group "shaders", of which the first
// one whose conditions hold wins; the other groups win over this one.
#pragma once

#include "osgRayTrace/bridge/appearance/materials/MaterialParameters.h"
#include "osgRayTrace/bridge/appearance/materials/ShaderRule.h"
#include "osgRayTrace/bridge/common/NamePattern.h"
#include "osgRayTrace/bridge/common/ShaderState.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/Node>

#include <deque>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

struct MaterialRule
{
    std::string group; ///< "nodes", "materials", "textures"
    std::string pattern;
    osg::ref_ptr<const PhysicalMaterial> material; ///< material, named after the pattern
    bool keepsColor = true;                        ///< true: the file gives no baseColor
    /// True: the rule changes the values that it gives of the model's own material, and leaves a
    /// material of which that changes nothing as it is.
    bool edits = false;
    std::vector<std::pair<const Parameter*, Values>> given; ///< parameters that the file gives
};

/// Largest number of names with "*" in a group, because each name of the scene that is no name of
/// the group is compared with all of them. Other names cost the same however many they are. It is
/// the largest number of rules in "shaders", too.
constexpr std::size_t kMostPatterns = 1024;

/// Holds the rules of a group, in the order of the file.
class MaterialRuleList
{
public:
    /// Adds a rule. Returns null if there already is a rule of this pattern.
    MaterialRule* add(MaterialRule rule);

    /// Returns the best rule for a name; null: none. The rule lives as long as the list.
    const MaterialRule* find(const std::string& name) const;

    /// Returns the number of rules with "*".
    std::size_t patterns() const { return _patterns.size(); }
    bool empty() const { return _rules.empty(); }
    std::size_t size() const { return _rules.size(); }
    const MaterialRule& operator[](std::size_t i) const { return _rules[i]; }
    auto begin() const { return _rules.begin(); }
    auto end() const { return _rules.end(); }

private:
    std::deque<MaterialRule> _rules;
    std::unordered_map<std::string, std::size_t> _byName;
    std::vector<std::size_t> _patterns; ///< indices of rules with "*"
};

/// Holds the rules of a file. A library is immutable once it is made.
struct MaterialLibrary
{
    MaterialRuleList nodes, materials, textures;
    std::vector<ShaderRule> shaders;
    std::shared_ptr<const ShaderReads> reads; ///< what shaders read; null if there are none
    bool readsUserValues = false;             ///< whether any of shaders does
};

struct MaterialLibraryResult
{
    std::shared_ptr<const MaterialLibrary> library; ///< null if there is an error
    std::string error; ///< "glass.json:7: materials, 'chrome': 'shiny' is no parameter; ..."
};

/// Parses the text of a library. fileName appears in messages only.
MaterialLibraryResult parseMaterialLibrary(const std::string& text, const std::string& fileName);

/// Reads a library from a file, which is found as OSG finds data files.
MaterialLibraryResult readMaterialLibrary(const std::string& fileName);

/// Holds the library that settings name. The file is read again only if its name differs from the
/// last one or again is true. A wrong file is reported once and gives no library.
class MaterialLibraryFile
{
public:
    std::shared_ptr<const MaterialLibrary> materials(const std::string& fileName, bool again);

private:
    std::string _fileName = "none";
    std::shared_ptr<const MaterialLibrary> _library;
};

} // namespace osgRayTrace::engine
