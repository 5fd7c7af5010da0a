// ObjectIdentity.h - tells OSG's objects apart by more than an address. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Observer>
#include <osg/Referenced>
#include <osg/ref_ptr>

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// Releases a reference. An address is an identity only while its object lives: malloc gives the
/// address of a deleted object to the next one of its size. Whatever is compared by address is
/// therefore either kept alive, as Kept does, or known by its ObjectName.

struct Unref
{
    void operator()(const osg::Referenced* object) const { object->unref(); }
};

/// Owns a reference like an osg::ref_ptr, but can be moved without a change of the reference count.
template <class T> using Kept = std::unique_ptr<T, Unref>;

/// Returns one more reference to the object; null stays null.
template <class T> Kept<T> keep(T* object)
{
    if (object) object->ref();
    return Kept<T>(object);
}

using KeptObjects = std::vector<Kept<const osg::Referenced>>;

/// Names an object without keeping it alive: two names are equal if they name one object, even
/// after it is deleted.
class ObjectName
{
public:
    ObjectName() = default;
    ObjectName(const osg::Referenced* object)
        : _observers(object ? object->getOrCreateObserverSet() : nullptr)
    {
    }

    bool operator==(const ObjectName& other) const { return _observers == other._observers; }
    bool operator!=(const ObjectName& other) const { return !(*this == other); }

    /// Returns the name without OSG, for the engine: equal if the names are, and null for no
    /// object.
    std::shared_ptr<const void> hostName() const
    {
        if (!_observers) return nullptr;
        return {_observers.get(), [kept = _observers](const void*) {}};
    }

private:
    /// Every object has an observer set of its own, which outlives it here.
    osg::ref_ptr<osg::ObserverSet> _observers;
};

} // namespace osgRayTrace::engine
