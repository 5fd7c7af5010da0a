// ClassicLocale.h - numbers with a point in text files, in any locale. Layer: plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/ObjectWrapper>

/// Lets all serializers that the wrapper has by now write in the classic locale. OSG's streams take
/// the global locale of the process, which may write 0,73: OSG's readers would take that for 0.
void writeInClassicLocale(osgDB::ObjectWrapper& wrapper);
