// Extras.cpp - turns JSON values into user values. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/Extras.h"

#include <nlohmann/json.hpp>
#include <osg/ValueObject>

namespace osgRayTrace::gltf
{

namespace
{

void setValue(const std::string& name, const Json& value, osg::Object& object)
{
    if (value.is_string())
        object.setUserValue(name, value.get_ref<const std::string&>());
    else if (value.is_boolean())
        object.setUserValue(name, value.get<bool>());
    else if (value.is_number())
        object.setUserValue(name, value.get<double>());
    else
        object.setUserValue(name, value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

} // namespace

void setExtras(const JsonPlace& place, osg::Object& object)
{
    const auto extras = place.find("extras");
    if (!extras) return;
    const Json& value = extras->value();
    if (!value.is_object()) return setValue("extras", value, object);
    for (const auto& member : value.items())
        setValue(member.key(), member.value(), object);
}

} // namespace osgRayTrace::gltf
