// JsonPlace.h - a value of a glTF file's JSON that knows its place, for checked reading. Layer:
// osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace osgRayTrace::gltf
{

using Json = nlohmann::json;

/// Returns the tree of a text. Throws GltfError with line and column if the text is no JSON, nests
/// deeper than 64 levels, or has more than 2^24 values.
std::shared_ptr<const Json> parseJson(const std::string& text);

/// Refers to a value of a tree, which must live as long. Each query throws GltfError with the place
/// if the value is not what was asked for.
class JsonPlace
{
public:
    explicit JsonPlace(const Json& value, std::string path = {})
        : _value(&value), _path(std::move(path))
    {
    }

    /// Refers to an object without members.
    static JsonPlace empty();

    /// Returns a member of an object; nothing if there is none of this name.
    std::optional<JsonPlace> find(const char* name) const;

    /// Returns a member that must be there.
    JsonPlace at(const char* name) const;

    /// Returns the object of an extension; nothing if the value does not use the extension.
    std::optional<JsonPlace> extension(const char* name) const;

    /// Returns the number of an array's elements.
    std::size_t size() const;
    JsonPlace operator[](std::size_t element) const;

    /// Returns the length of a member that is an array; 0 if there is no such member.
    std::size_t sizeOf(const char* name) const;

    std::uint64_t whole() const; ///< a whole number, 0 to 2^53
    float number() const;        ///< a finite number
    bool flag() const;
    const std::string& text() const;

    /// Returns a whole number that is below a limit, to be used as an index.
    std::size_t index(std::size_t limit) const;

    std::uint64_t wholeOr(const char* name, std::uint64_t missing) const;
    float numberOr(const char* name, float missing) const;
    bool flagOr(const char* name, bool missing) const;
    std::string textOr(const char* name, const std::string& missing) const;

    /// Returns the index that a member is; nothing if there is no such member.
    std::optional<std::size_t> indexOf(const char* name, std::size_t limit) const;

    /// Returns an array of exactly so many numbers.
    template <std::size_t count> std::array<float, count> numbers() const
    {
        if (size() != count) refuse("is not an array of " + std::to_string(count) + " numbers");
        std::array<float, count> values;
        for (std::size_t i = 0; i < count; ++i)
            values[i] = (*this)[i].number();
        return values;
    }
    template <std::size_t count>
    std::array<float, count> numbersOr(const char* name,
                                       const std::array<float, count>& missing) const
    {
        const auto member = find(name);
        return member ? member->numbers<count>() : missing;
    }

    const Json& value() const { return *_value; }
    const std::string& path() const { return _path; }

    [[noreturn]] void refuse(const std::string& problem) const;

private:
    const Json* _value;
    std::string _path;
};

} // namespace osgRayTrace::gltf
