// LocatedJson.cpp - makes a tree of a parser's events. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/LocatedJson.h"

namespace osgRayTrace::engine
{

const char* wordOf(LocatedJson::Kind kind)
{
    switch (kind)
    {
    case LocatedJson::Kind::Null:
        return "null";
    case LocatedJson::Kind::Boolean:
        return "true or false";
    case LocatedJson::Kind::Number:
        return "a number";
    case LocatedJson::Kind::Text:
        return "a string";
    case LocatedJson::Kind::Array:
        return "an array";
    case LocatedJson::Kind::Object:
        return "an object";
    }
    return "";
}

bool LocatedJsonBuilder::open(LocatedJson::Kind kind, int line)
{
    if (_open.size() == kDeepest) return false;
    LocatedJson value;
    value.kind = kind;
    const bool named = !_open.empty() && _open.back().is(LocatedJson::Kind::Object);
    value.line = named ? _line : line;
    if (named) value.name = _name;
    _open.push_back(std::move(value));
    return true;
}

bool LocatedJsonBuilder::close()
{
    LocatedJson value = std::move(_open.back());
    _open.pop_back();
    if (_open.empty())
    {
        _done = std::move(value);
        return true;
    }
    _open.back().children.push_back(std::move(value));
    return false;
}

void LocatedJsonBuilder::add(LocatedJson value)
{
    LocatedJson& around = _open.back();
    const bool named = around.is(LocatedJson::Kind::Object);
    value.line = named ? _line : around.line;
    if (named) value.name = _name;
    around.children.push_back(std::move(value));
}

} // namespace osgRayTrace::engine
