// Machine.h - what a report was made on and with. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

namespace osgRayTrace::bench
{

/// Processor, threads, instruction set, versions of this project, Embree, OpenSceneGraph and the
/// compiler.
std::map<std::string, std::string> describeMachine(int threads);

} // namespace osgRayTrace::bench
