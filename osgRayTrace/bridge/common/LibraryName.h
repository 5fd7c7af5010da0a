// LibraryName.h - tells the kit of an object by the library that its class names. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Object>

#include <cstring>

namespace osgRayTrace::engine
{

/// Returns whether the object's class is one of this library.
inline bool isFrom(const osg::Object* object, const char* library)
{
    return std::strcmp(object->libraryName(), library) == 0;
}

} // namespace osgRayTrace::engine
