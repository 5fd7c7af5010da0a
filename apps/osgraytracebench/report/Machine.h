// Machine.h - the machine and the software of a report. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

namespace osgRayTrace::bench
{

/// Returns processor, threads, instruction set, and versions of this project, Embree,
/// OpenSceneGraph and the compiler.
std::map<std::string, std::string> describeMachine(int threads);

} // namespace osgRayTrace::bench
