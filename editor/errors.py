"""The editor's refusals."""

from __future__ import annotations

from vipo_device.protocol.errors import VipoError


class EditorError(VipoError):
    """A refusal of the editor."""

    code = "editor"


class NoSuchProgram(EditorError):
    """The program, version or function does not exist, or the user has no part in its site; both look the same."""

    code = "not_found"
    status = 404


class BadRequest(EditorError):
    """What was asked for cannot be done as asked; the message says how it could."""

    code = "bad_request"
    status = 422


class DocumentHole(EditorError):
    """Changes are missing in the database on which others build; what is there is not shown as if it were all."""

    code = "document_hole"
    status = 409


class NotStored(EditorError):
    """What stands on somebody's screen is not in the database yet, so nothing can be made of it."""

    code = "not_stored"
    status = 409


class UnreadableVersion(EditorError):
    """A version was written by a later VIPO, or is damaged."""

    code = "unreadable_version"
    status = 409


class NotApproved(EditorError):
    """A site demands approvals of what runs on its devices, and this content does not have them."""

    code = "not_approved"
    status = 409


class NeedsPerson(EditorError):
    """A token asks for what a person alone decides."""

    code = "not_for_tokens"
    status = 403


class MayNotReview(EditorError):
    """Somebody may not approve this content: it is their own, or the site wants another role for it."""

    code = "may_not_review"
    status = 409


class NameTaken(EditorError):
    """A name of the site's library belongs to somebody else's function, which only they and admins go on with."""

    code = "name_taken"
    status = 409


class NotYours(EditorError):
    """A function of the library is somebody else's: its author and the admins of its site change it."""

    code = "not_yours"
    status = 409
