// JsonPlace.cpp - parses JSON within limits and checks the kinds of its values. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/JsonPlace.h"

#include "osgPlugins/gltf/GltfError.h"
#include "osgRayTrace/base/NeverDestroyed.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace osgRayTrace::gltf
{

namespace
{

constexpr int kDeepest = 64;
constexpr std::size_t kMostValues = std::size_t(1) << 24;
constexpr double kLargestWhole = 9007199254740992.0; ///< 2^53

/// Returns the parser's message without its own prefix in brackets.
std::string messageOf(const Json::exception& error)
{
    const std::string text = error.what();
    const std::size_t end = text.find("] ");
    return end == std::string::npos ? text : text.substr(end + 2);
}

/// Returns what an empty place refers to. It owns no memory, which would be lost each time the
/// plugin is unloaded.
const Json& nothing()
{
    static const engine::NeverDestroyed<Json> null;
    return *null;
}

} // namespace

std::shared_ptr<const Json> parseJson(const std::string& text)
{
    std::size_t values = 0;
    const auto count = [&values](int depth, Json::parse_event_t, Json&)
    {
        if (depth > kDeepest) throw GltfError("JSON", "nests deeper than 64 levels");
        if (++values > kMostValues) throw GltfError("JSON", "has more than 2^24 values");
        return true;
    };
    try
    {
        return std::make_shared<const Json>(Json::parse(text, count));
    }
    catch (const Json::exception& error)
    {
        throw GltfError("JSON", messageOf(error));
    }
}

JsonPlace JsonPlace::empty()
{
    return JsonPlace(nothing());
}

std::optional<JsonPlace> JsonPlace::find(const char* name) const
{
    if (_value == &nothing()) return std::nullopt;
    if (!_value->is_object()) refuse("is no object");
    const auto member = _value->find(name);
    if (member == _value->end()) return std::nullopt;
    return JsonPlace(*member, _path.empty() ? name : _path + "." + name);
}

JsonPlace JsonPlace::at(const char* name) const
{
    const auto member = find(name);
    if (!member) refuse(std::string("has no '") + name + "'");
    return *member;
}

std::optional<JsonPlace> JsonPlace::extension(const char* name) const
{
    const auto extensions = find("extensions");
    if (!extensions) return std::nullopt;
    const auto found = extensions->find(name);
    if (found && !found->value().is_object()) found->refuse("is no object");
    return found;
}

std::size_t JsonPlace::size() const
{
    if (!_value->is_array()) refuse("is no array");
    return _value->size();
}

JsonPlace JsonPlace::operator[](std::size_t element) const
{
    if (element >= size()) refuse("has no element " + std::to_string(element));
    return JsonPlace((*_value)[element], _path + "[" + std::to_string(element) + "]");
}

std::size_t JsonPlace::sizeOf(const char* name) const
{
    const auto member = find(name);
    return member ? member->size() : 0;
}

std::uint64_t JsonPlace::whole() const
{
    if (!_value->is_number()) refuse("is no number");
    const double value = _value->get<double>();
    if (!(value >= 0.0 && value <= kLargestWhole) || value != std::floor(value))
        refuse("is no whole number from 0 to 2^53");
    return static_cast<std::uint64_t>(value);
}

float JsonPlace::number() const
{
    if (!_value->is_number()) refuse("is no number");
    const double value = _value->get<double>();
    if (!(std::fabs(value) <= std::numeric_limits<float>::max())) refuse("is too large a number");
    return static_cast<float>(value);
}

bool JsonPlace::flag() const
{
    if (!_value->is_boolean()) refuse("is neither true nor false");
    return _value->get<bool>();
}

const std::string& JsonPlace::text() const
{
    if (!_value->is_string()) refuse("is no string");
    return _value->get_ref<const std::string&>();
}

std::size_t JsonPlace::index(std::size_t limit) const
{
    const std::uint64_t value = whole();
    if (value >= limit)
        refuse("is " + std::to_string(value) + ", and there are " + std::to_string(limit));
    return static_cast<std::size_t>(value);
}

std::uint64_t JsonPlace::wholeOr(const char* name, std::uint64_t missing) const
{
    const auto member = find(name);
    return member ? member->whole() : missing;
}

float JsonPlace::numberOr(const char* name, float missing) const
{
    const auto member = find(name);
    return member ? member->number() : missing;
}

bool JsonPlace::flagOr(const char* name, bool missing) const
{
    const auto member = find(name);
    return member ? member->flag() : missing;
}

std::string JsonPlace::textOr(const char* name, const std::string& missing) const
{
    const auto member = find(name);
    return member ? member->text() : missing;
}

std::optional<std::size_t> JsonPlace::indexOf(const char* name, std::size_t limit) const
{
    const auto member = find(name);
    return member ? std::optional<std::size_t>(member->index(limit)) : std::nullopt;
}

void JsonPlace::refuse(const std::string& problem) const
{
    throw GltfError(_path, problem);
}

} // namespace osgRayTrace::gltf
