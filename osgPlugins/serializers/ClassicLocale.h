// ClassicLocale.h - numbers in text files with a point, whatever the process's locale. Layer:
// plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/ObjectWrapper>

/// Lets all serializers that the wrapper has by now write in the classic locale. OSG's streams take
/// the global one of the process, which may write 0,73: OSG's readers would take it for 0.
void writeInClassicLocale(osgDB::ObjectWrapper& wrapper);
