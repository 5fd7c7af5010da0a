// MaterialParametersTest.cpp - each parameter survives all ways in and out. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include "osgRayTrace/bridge/appearance/materials/MaterialLibrary.h"
#include "osgRayTrace/bridge/appearance/materials/MaterialListing.h"
#include "osgRayTrace/bridge/appearance/materials/MaterialParameters.h"

#include <nlohmann/json.hpp>
#include <osg/Material>
#include <osgDB/Registry>

#include <set>
#include <sstream>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

/// Returns values in a parameter's range that are none of its defaults.
Values otherValues(const Parameter& parameter)
{
    const osg::ref_ptr<PhysicalMaterial> plain = new PhysicalMaterial;
    Values values = parameter.get(*plain);
    if (parameter.name == std::string("interiorDropletSize")) return {20.0}; // 0, or from 5 on
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        const std::set<std::string> whole = {"thinWalled", "vertexColors", "interiorPriority"};
        const double step = whole.count(parameter.name) ? 1.0 : 0.0625 * double(i + 1);
        values[i] += values[i] + step <= parameter.highest ? step : -step;
    }
    return values;
}

/// Returns the values after the format of OSG's with this extension.
Values afterFile(const PhysicalMaterial& material, const Parameter& parameter,
                 const std::string& extension, const std::string& type)
{
    auto* format = osgDB::Registry::instance()->getReaderWriterForExtension(extension);
    REQUIRE(format);
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setPluginStringData("fileType", type);
    std::stringstream stream;
    REQUIRE(format->writeObject(material, stream, options).success());
    auto result = format->readObject(stream, options);
    const auto* copy = dynamic_cast<PhysicalMaterial*>(result.getObject());
    REQUIRE(copy);
    return parameter.get(*copy);
}

/// Returns a triangle with a material of that name and a PhysicalMaterial.
osg::ref_ptr<osg::Geometry> named(PhysicalMaterial* material)
{
    const auto geometry = triangleGeometry();
    const osg::ref_ptr<osg::Material> classic = new osg::Material;
    classic->setName("part");
    geometry->getOrCreateStateSet()->setAttribute(classic);
    geometry->getStateSet()->setAttribute(material);
    return geometry;
}

} // namespace

TEST_CASE("parameters: each goes through the API, OSG's formats and the material file",
          "[bridge][material]")
{
    std::set<std::string> names;
    for (const Parameter* parameter : allParameters())
    {
        CAPTURE(parameter->name);
        CHECK(names.insert(parameter->name).second);
        CHECK(findParameter(parameter->name) == parameter);
        const Values values = otherValues(*parameter);
        REQUIRE(values.size() == parameter->count);
        const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
        parameter->set(*material, values);
        CHECK(parameter->get(*material) == values);
        // Nothing else has changed.
        for (const Parameter* other : allParameters())
            if (other != parameter)
                CHECK(other->get(*material) == other->get(*osg::ref_ptr(new PhysicalMaterial)));

        for (const auto& [extension, type] :
             {std::pair("osgt", "Ascii"), std::pair("osgb", "Binary"), std::pair("osgx", "XML")})
        {
            CAPTURE(extension);
            CHECK(afterFile(*material, *parameter, extension, type) == values);
        }

        const MaterialListing listing = listMaterials(*named(material));
        const auto json = nlohmann::json::parse(listing.text);
        const auto& listed = json.at("materials").at("part").at(parameter->name);
        const Values written =
            listed.is_array() ? listed.get<Values>() : Values{listed.get<double>()};
        REQUIRE(written.size() == values.size());
        for (std::size_t i = 0; i < values.size(); ++i) // in the digits that a float needs
            CHECK(float(written[i]) == float(values[i]));
        // A file with the value gives it to the material.
        const nlohmann::json file = {{"materials", {{"part", {{parameter->name, listed}}}}}};
        const auto parsed = parseMaterialLibrary(file.dump(), "m.json");
        REQUIRE(parsed.error == "");
        CHECK(parameter->get(*parsed.library->materials[0].material) == values);
    }
    CHECK(names.size() == allParameters().size());
    CHECK(names.size() > 20);
}
