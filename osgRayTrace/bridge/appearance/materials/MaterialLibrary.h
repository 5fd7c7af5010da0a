// MaterialLibrary.h - physical materials for models that know none, by names in them. Layer:
// bridge.
// SPDX-License-Identifier: MIT
//
// A JSON file:
//   { "nodes":     { "windscreen": { "transmission": 1, "roughness": 0, "baseColor": [1, 1, 1] } },
//     "materials": { "chrome*":    { "metallic": 1, "roughness": 0.05 } },
//     "textures":  { "wood.png":   { "roughness": 0.3 } } }
// Names are those of nodes (the nearest above or at the geometry), of the osg::Material that it is
// drawn with, and of the image file of its texture, with or without folders. "*" stands for any
// characters. A node's entry wins over a material's, and that over a texture's; in each group a
// name over a pattern, and the first of several patterns. Parameters are those of PhysicalMaterial;
// without baseColor the diffuse colour and the texture of the model stay.
#pragma once

#include <osgRayTrace/PhysicalMaterial>

#include <osg/Node>

#include <deque>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace osgRayTrace::engine
{

struct MaterialRule
{
    std::string group; ///< "nodes", "materials", "textures"
    std::string pattern;
    osg::ref_ptr<const PhysicalMaterial> material; ///< its name is the pattern
    bool keepsColor = true;                        ///< there is no baseColor
};

/// Names with "*" in a group: each name of the scene that is no name of the group is compared with
/// all of these. Other names cost the same however many they are.
constexpr std::size_t kMostPatterns = 1024;

/// The rules of a group, in the order of the file.
class MaterialRuleList
{
public:
    /// Null if there is a rule of this pattern.
    MaterialRule* add(MaterialRule rule);

    /// The best rule for a name; null: none. It lives as long as the list.
    const MaterialRule* find(const std::string& name) const;

    std::size_t patterns() const { return _patterns.size(); } ///< with "*"
    bool empty() const { return _rules.empty(); }
    std::size_t size() const { return _rules.size(); }
    const MaterialRule& operator[](std::size_t i) const { return _rules[i]; }
    auto begin() const { return _rules.begin(); }
    auto end() const { return _rules.end(); }

private:
    std::deque<MaterialRule> _rules;
    std::unordered_map<std::string, std::size_t> _byName;
    std::vector<std::size_t> _patterns; ///< those with "*"
};

/// Immutable once it is made.
struct MaterialLibrary
{
    MaterialRuleList nodes, materials, textures;
};

/// True if '*' in pattern can stand for characters so that it is the name.
bool matchesPattern(const std::string& pattern, const std::string& name);

struct MaterialLibraryResult
{
    std::shared_ptr<const MaterialLibrary> library; ///< null if there is an error
    std::string error; ///< "glass.json:7: materials, 'chrome': 'shiny' is no parameter; ..."
};

/// fileName stands in messages only.
MaterialLibraryResult parseMaterialLibrary(const std::string& text, const std::string& fileName);

/// Found as OSG finds data files.
MaterialLibraryResult readMaterialLibrary(const std::string& fileName);

/// The library that settings name, read again only if the name is another one or again is true. A
/// wrong file is reported once and gives none.
class MaterialLibraryFile
{
public:
    std::shared_ptr<const MaterialLibrary> materials(const std::string& fileName, bool again);

private:
    std::string _fileName = "none";
    std::shared_ptr<const MaterialLibrary> _library;
};

} // namespace osgRayTrace::engine
