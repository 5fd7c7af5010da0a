// PictureArray.h - images as numpy arrays that share their memory. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/numpy.h>

#include <osg/Image>

namespace osgRayTrace::python
{

/// Returns an array over the pixels of an image, which lives as long as the array does. Row 0 is at
/// the top of the picture, so that steps from row to row are negative. The shape is (height, width)
/// for one channel and (height, width, channels) for more. Throws pybind11::error_already_set
/// (MemoryError) for a null image.
pybind11::array pictureArray(const osg::ref_ptr<osg::Image>& image);

} // namespace osgRayTrace::python
