// LocatedJson.h - a part of a JSON file as a tree that knows its lines. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds a value with the line of its name, or of the value itself in an array.
struct LocatedJson
{
    enum class Kind
    {
        Null,
        Boolean,
        Number,
        Text,
        Array,
        Object
    };

    Kind kind = Kind::Null;
    int line = 0;
    std::string name; ///< name in the object around; empty in an array
    bool boolean = false;
    double number = 0.0;
    std::string text;
    std::vector<LocatedJson> children; ///< items or members, in the order of the file

    bool is(Kind other) const { return kind == other; }
};

/// Returns "a number", "an array" and the like.
const char* wordOf(LocatedJson::Kind kind);

/// Makes a tree of a parser's events.
class LocatedJsonBuilder
{
public:
    /// The deepest value has this many arrays and objects around it.
    static constexpr std::size_t kDeepest = 5;

    void key(const std::string& name, int line)
    {
        _name = name;
        _line = line;
    }

    /// Begins an array or an object. Returns false if it lies too deep.
    bool open(LocatedJson::Kind kind, int line);

    /// Ends the innermost array or object. Returns true if it was the outermost one.
    bool close();

    /// Adds a value to the innermost array or object.
    void add(LocatedJson value);

    /// Returns the outermost array or object after its end.
    LocatedJson take() { return std::move(_done); }

    bool isOpen() const { return !_open.empty(); }

private:
    std::vector<LocatedJson> _open;
    LocatedJson _done;
    std::string _name;
    int _line = 0;
};

} // namespace osgRayTrace::engine
