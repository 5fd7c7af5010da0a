// MaterialHook.cpp - the one place for the class's virtual table. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/MaterialHook>

namespace osgRayTrace
{

MaterialHook::MaterialHook() = default;

MaterialHook::~MaterialHook() = default;

} // namespace osgRayTrace
