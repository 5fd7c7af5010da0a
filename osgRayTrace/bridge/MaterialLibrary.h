// MaterialLibrary.h - physical materials for models that know none, by names in them. Layer:
// bridge. SPDX-License-Identifier: MIT
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

#include <memory>
#include <string>
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

/// Immutable once it is made.
struct MaterialLibrary
{
    std::vector<MaterialRule> nodes, materials, textures; ///< in the order of the file
};

/// The best rule for a name; null: none. Rules live as long as the list.
const MaterialRule* findRule(const std::vector<MaterialRule>& rules, const std::string& name);

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
