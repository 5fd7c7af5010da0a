// MatrixArray.cpp - transposes matrices, and refuses bad ones. Layer: apps.
// SPDX-License-Identifier: MIT
#include "MatrixArray.h"

#include <cmath>

namespace osgRayTrace::python
{

namespace py = pybind11;

osg::Matrixd matrixOf(const MatrixArray& array, const std::string& name)
{
    if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4)
        throw py::value_error(name + " is not a matrix of 4 x 4 numbers");
    osg::Matrixd matrix;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
        {
            const double value = array.at(row, column);
            if (!std::isfinite(value)) throw py::value_error(name + " is not finite");
            matrix(column, row) = value;
        }
    return matrix;
}

MatrixArray arrayOf(const osg::Matrixd& matrix)
{
    MatrixArray array({4, 4});
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            array.mutable_at(row, column) = matrix(column, row);
    return array;
}

osg::Vec3d vectorOf(const std::array<double, 3>& values, const std::string& name)
{
    for (const double value : values)
        if (!std::isfinite(value)) throw py::value_error(name + " is not finite");
    return osg::Vec3d(values[0], values[1], values[2]);
}

} // namespace osgRayTrace::python
