// MatrixArray.h - matrices and vectors of Python as OSG's. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/numpy.h>

#include <osg/Matrixd>
#include <osg/Vec3d>

#include <array>
#include <string>

namespace osgRayTrace::python
{

using MatrixArray =
    pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// Returns a matrix that is applied to column vectors as one of OSG, which is applied to rows. The
/// name is the argument's. Throws pybind11::value_error unless the array is 4 x 4 and finite.
osg::Matrixd matrixOf(const MatrixArray& array, const std::string& name);

/// Returns a matrix of OSG as one that is applied to column vectors.
MatrixArray arrayOf(const osg::Matrixd& matrix);

/// Returns a vector. The name is the argument's. Throws pybind11::value_error unless it is finite.
osg::Vec3d vectorOf(const std::array<double, 3>& values, const std::string& name);

} // namespace osgRayTrace::python
