// VdbSamples.h - reads the OpenVDB files of the source tree. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/plugins/VdbFiles.h"

namespace osgRayTrace::test
{

/// Returns the bytes of one of kVdbFiles.
inline std::string vdbFile(const std::string& name)
{
    return fileBytes(std::string(OSGRAYTRACE_TEST_SOURCE) + "/tests/plugins/vdb/" + name + ".vdb");
}

} // namespace osgRayTrace::test
