// PictureArray.cpp - hands the memory of images to numpy. Layer: apps.
// SPDX-License-Identifier: MIT
#include "PictureArray.h"

#include <vector>

namespace osgRayTrace::python
{

namespace py = pybind11;

py::array pictureArray(const osg::ref_ptr<osg::Image>& image)
{
    if (!image)
    {
        PyErr_SetString(PyExc_MemoryError, "there is not enough memory for the image");
        throw py::error_already_set();
    }
    using Holder = osg::ref_ptr<osg::Image>;
    const py::capsule owner(new Holder(image),
                            [](void* holder) { delete static_cast<Holder*>(holder); });

    const bool bytes = image->getDataType() == GL_UNSIGNED_BYTE;
    const py::dtype type = bytes ? py::dtype::of<unsigned char>() : py::dtype::of<float>();
    const auto channels =
        static_cast<py::ssize_t>(osg::Image::computeNumComponents(image->getPixelFormat()));
    const auto rowStep = static_cast<py::ssize_t>(image->getRowStepInBytes());
    std::vector<py::ssize_t> shape{image->t(), image->s()};
    std::vector<py::ssize_t> strides{-rowStep, channels * type.itemsize()};
    if (channels > 1)
    {
        shape.push_back(channels);
        strides.push_back(type.itemsize());
    }
    return py::array(type, shape, strides, image->data(0, image->t() - 1), owner);
}

} // namespace osgRayTrace::python
