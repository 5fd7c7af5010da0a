// OptionChecks.h - which options of the command line go together. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Options.h"

namespace osgRayTrace::app
{

/// Throws Failure(kUsage) if the options do not make sense together.
void checkOptions(const Options& options);

} // namespace osgRayTrace::app
