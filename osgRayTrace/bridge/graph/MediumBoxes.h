// MediumBoxes.h - the boxes of MediumVolumes, as meshes that bound their medium. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/MediumVolume>

#include <osg/Geometry>

#include <map>

namespace osgRayTrace::engine
{

/// Holds the meshes of boxes between conversions.
class MediumBoxes
{
public:
    void begin() { ++_round; }

    /// Returns the six faces of a volume's box, whose state is a boundary that bends no light and
    /// encloses the volume's medium; null: the box has no extent along some axis. The volume has a
    /// medium. Until end() the geometry stays, and from one conversion to the next as long as the
    /// volume is asked for.
    const osg::Geometry* of(const MediumVolume& volume);

    /// Forgets the volumes that were not asked for.
    void end();

    /// Forgets the volumes that nobody else holds.
    void dropUnshared();

private:
    struct Entry
    {
        osg::ref_ptr<const MediumVolume> volume; ///< keeps the address unique
        osg::ref_ptr<osg::Geometry> geometry;
        osg::ref_ptr<const osgRayTrace::Medium> medium;
        osg::BoundingBox box; ///< of geometry
        unsigned int used = 0;
    };

    std::map<const MediumVolume*, Entry> _entries;
    unsigned int _round = 0;
};

} // namespace osgRayTrace::engine
