// MaterialDetails.h - the parameters of PhysicalMaterial that few surfaces have. Layer: plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/Serializer>

/// Returns a serializer that writes these parameters by name. Nothing is written if all of them
/// have their defaults, and nothing is missed in files, binary ones included, that have none.
osgDB::BaseSerializer* materialDetails();
