"""Views of a simulation's fields."""
import numpy as np


class StaleField(ReferenceError):
    """The field is of a moment that has passed: the simulation has stepped on. Ask for it again."""


class Field(np.lib.mixins.NDArrayOperatorsMixin):
    """One quantity of a simulation, at this moment: the solver's own numbers, read-only and not copied.

    A field of one component is used as an array: `field[3, 4]`, `field.max()` by numpy (`np.max(field)`), `2 * field`. Axes are those of
    space, [x, y] or [x, y, z], so that its shape is the scene's grid.cells (a face component has one more along its own axis); of
    particles [i]. A vector has its components as fields, `field.x` or `field[0]`; `numpy.asarray(field)` stacks them, with a copy, as the
    last axis, where they stand at the same places: those of faces do not, and have their means at cells' centres by cells().

    After a step the field is stale and raises StaleField. An array made of it (`numpy.asarray(field)`, a slice) shares its memory: the
    simulation refuses to step (BufferError) while such an array is kept; `numpy.array(field)` and `field.copy()` are copies to keep.
    """

    __slots__ = ("_core", "_moment", "_set", "name", "unit", "where", "_axes")

    def __init__(self, core, set, name, unit, where, axes, moment=None):
        self._core, self._moment, self._set = core, core.moment if moment is None else moment, set
        self.name, self.unit, self.where, self._axes = name, unit, where, tuple(axes)

    def _component(self, axis):
        if self._core.moment != self._moment:
            raise StaleField(f'field "{self.name}" is of a moment that has passed: the simulation has stepped on; ask for it again')
        return self._core.component(self._set, self.name, axis)

    def __array__(self, dtype=None):
        if len(self._axes) == 1:
            array = self._component(self._axes[0])
        else:
            self._refuse_faces()
            array = np.stack([self._component(axis) for axis in self._axes], axis=-1)
        return array if dtype is None else array.astype(dtype, copy=False)

    def __array_ufunc__(self, ufunc, method, *inputs, **kwargs):
        if any(isinstance(out, Field) for out in kwargs.get("out", ())):
            return NotImplemented  # fields are read-only
        return getattr(ufunc, method)(*(np.asarray(x) if isinstance(x, Field) else x for x in inputs), **kwargs)

    def __getitem__(self, key):
        if len(self._axes) == 1:
            return self._component(self._axes[0])[key]
        if isinstance(key, (int, np.integer)):
            return self._part(self._axes[key])
        return np.asarray(self)[key]

    def __len__(self):
        return len(self._axes) if len(self._axes) > 1 else self.shape[0]

    def __iter__(self):
        return (self[i] for i in range(len(self)))

    @property
    def x(self):
        return self._of(0)

    @property
    def y(self):
        return self._of(1)

    @property
    def z(self):
        return self._of(2)

    def cells(self):
        """The vector at the cells' centres: the mean of each cell's two faces, as files have it. A copy, components last."""
        if self.where != "face" or len(self._axes) == 1:
            raise ValueError(f'"{self.name}" is no vector of faces')
        return np.stack([(np.take(u, range(1, u.shape[a]), a) + np.take(u, range(u.shape[a] - 1), a)) / 2
                         for a, u in ((a, self._component(a)) for a in self._axes)], axis=-1)

    def _refuse_faces(self):
        if self.where == "face":
            raise ValueError(f'the components of "{self.name}" stand at the faces of each axis, in arrays of different shapes: '
                             "take .x, .y or .z, or cells() for their means at cells' centres")

    def _of(self, axis):
        if axis not in self._axes or len(self._axes) == 1:
            raise AttributeError(f'field "{self.name}" has no component {"xyz"[axis]}')
        return self._part(axis)

    def _part(self, axis):
        """A component, of the same moment."""
        return Field(self._core, self._set, self.name, self.unit, self.where, (axis,), self._moment)

    @property
    def components(self):
        """1, or that of a vector."""
        return len(self._axes)

    @property
    def shape(self):
        """That of the array: space first, components last."""
        if len(self._axes) == 1:
            return self._component(self._axes[0]).shape
        self._refuse_faces()
        return self._component(self._axes[0]).shape + (len(self._axes),)

    @property
    def ndim(self):
        """Number of axes of the array."""
        return len(self.shape)

    @property
    def size(self):
        """Number of values."""
        return int(np.prod(self.shape))

    dtype = np.dtype(np.float64)

    def copy(self):
        """An array of its own, to keep."""
        return np.array(self)

    def __repr__(self):
        if self._core.moment != self._moment:
            return f'<stale field "{self.name}">'
        shapes = " and ".join(str(self._component(axis).shape) for axis in self._axes) if self.where == "face" else self.shape
        return f'<field "{self.name}" [{self.unit}] {self.where} {shapes}>'


class Edit:
    """A field that is being written, as a block: `with sim.edit("smoke") as smoke: smoke[3:5, :] = 1`.

    A field of one component is written as an array; those of a vector are the arrays x, y and z, or [0], [1], [2]. At the end of the block
    they take the field's place, unless the block raises; then nothing has changed. Inside the block the simulation neither steps nor
    changes otherwise, and no other field is edited: BadInput.
    """

    def __init__(self, core, field):
        self._core, self.name = core, f"{field._set}.{field.name}" if field._set else field.name
        self._arrays, self._moment = [np.array(field._component(axis), order="F") for axis in field._axes], core.moment

    def __enter__(self):
        if self._core.moment != self._moment:
            raise StaleField(f'the simulation has stepped on since "{self.name}" was read for this block; ask for it again')
        self._core.begin_edit(self.name)
        return self

    def __exit__(self, kind, error, trace):
        self._core.end_edit()
        if kind is None:
            self._core.write(self.name, self._arrays)

    def __getitem__(self, key):
        return self._arrays[0][key] if len(self._arrays) == 1 else self._arrays[key]

    def __setitem__(self, key, value):
        if len(self._arrays) == 1:
            self._arrays[0][key] = value
        else:
            self._arrays[key][...] = value

    def __array__(self, dtype=None):
        if len(self._arrays) > 1:
            raise ValueError(f'"{self.name}" is written by its components: .x, .y, .z')
        return self._arrays[0] if dtype is None else self._arrays[0].astype(dtype, copy=False)

    x = property(lambda self: self._of(0), lambda self, value: self.__setitem__(self._axis(0), value), doc="The array along x.")
    y = property(lambda self: self._of(1), lambda self, value: self.__setitem__(self._axis(1), value), doc="The array along y.")
    z = property(lambda self: self._of(2), lambda self, value: self.__setitem__(self._axis(2), value), doc="The array along z.")

    def _axis(self, axis):
        if axis >= len(self._arrays) or len(self._arrays) == 1:
            raise AttributeError(f'"{self.name}" has no component {"xyz"[axis]}')
        return axis

    def _of(self, axis):
        return self._arrays[self._axis(axis)]
