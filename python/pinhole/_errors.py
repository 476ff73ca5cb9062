"""Exceptions and warnings. Each exception is a ``pinhole.Error`` and also a built-in one with the same meaning."""


class Error(Exception):
    """Any error of pinhole."""


class InputError(Error, ValueError):
    """An argument, a setting, an array or the content of a file is not valid."""


class ForeignName(InputError, AttributeError):
    """A method of another program."""


class FileError(Error, OSError):
    """A file cannot be read or written."""


class DeviceError(Error, RuntimeError):
    """A device cannot do the work."""


class PackageError(Error, ImportError):
    """A package that is not installed is needed."""


class InternalError(Error, RuntimeError):
    """A defect of pinhole."""


class Note(UserWarning):
    """A warning about something that is not an error."""


for _class in (Error, InputError, FileError, DeviceError, InternalError, Note, PackageError):
    _class.__module__ = "pinhole"
