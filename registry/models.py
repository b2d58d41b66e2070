"""What exists: people, sites, maps, places, devices and what happened to them."""

from __future__ import annotations

import zlib
from typing import ClassVar

from django.contrib.auth.base_user import AbstractBaseUser, BaseUserManager
from django.db import models
from django.db.models.functions import Lower

from registry.alert_rows import DeviceAlert as DeviceAlert  # Django looks for models here
from registry.robot_map_rows import RobotMap as RobotMap  # Django looks for models here
from registry.robot_map_rows import RobotMapDraft as RobotMapDraft
from registry.robot_map_rows import RobotMapPart as RobotMapPart
from registry.thing_rows import ThingEvent as ThingEvent  # Django looks for models here
from registry.topic_rows import TopicClaim as TopicClaim  # Django looks for models here


class UserManager(BaseUserManager["User"]):
    """Makes users; e-mail addresses are kept in lower case."""

    def create_user(self, *, email: str, password: str | None, display_name: str, initials: str = "") -> User:
        """Make and save a user; without a password nobody can sign in as them."""
        user = self.model(
            email=email.strip().lower(),
            display_name=display_name,
            initials=initials or initials_of(display_name),
        )
        user.set_password(password)
        user.save(using=self._db)
        return user


def initials_of(name: str) -> str:
    """Return up to two capital letters that stand for a name."""
    words = [w for w in name.split() if w]
    return "".join(w[0] for w in (words[:1] + words[-1:] if len(words) > 1 else words)).upper()


class User(AbstractBaseUser):
    """A person; signs in by e-mail."""

    email = models.EmailField(unique=True)
    display_name = models.CharField(max_length=100)
    initials = models.CharField(max_length=4)
    is_active = models.BooleanField(default=True)
    created_at = models.DateTimeField(auto_now_add=True)

    objects: ClassVar[UserManager] = UserManager()
    USERNAME_FIELD = "email"
    EMAIL_FIELD = "email"
    REQUIRED_FIELDS: ClassVar[list[str]] = ["display_name"]

    class Meta:
        """One person for each address, however it is spelt."""

        constraints = [models.UniqueConstraint(Lower("email"), name="user_email_any_case")]

    def __str__(self) -> str:
        return self.email


class SignInFailure(models.Model):
    """A sign-in that failed, counted to slow down guessing."""

    email = models.CharField(max_length=254)
    address = models.CharField(max_length=64)
    at = models.DateTimeField()

    class Meta:
        """Found by address and by e-mail within the last minutes."""

        indexes = [models.Index(fields=["address", "at"]), models.Index(fields=["email", "at"])]

    def __str__(self) -> str:
        return f"{self.email} from {self.address}"


class Site(models.Model):
    """A place with its map, its devices and its members."""

    slug = models.SlugField(max_length=64, unique=True)
    name = models.CharField(max_length=100)
    join_key_hash = models.CharField(max_length=64, blank=True)
    join_broker_hash = models.CharField(max_length=160, blank=True)
    stop_active = models.BooleanField(default=False)
    stop_by = models.CharField(max_length=100, blank=True)
    stop_at = models.DateTimeField(null=True)
    created_at = models.DateTimeField(auto_now_add=True)

    def __str__(self) -> str:
        return self.slug


class Membership(models.Model):
    """What a person may do at a site."""

    class Role(models.TextChoices):
        """Each role may do all that the ones before it may."""

        VIEWER = "viewer"
        OPERATOR = "operator"
        AUTHOR = "author"
        ADMIN = "admin"

    user = models.ForeignKey(User, on_delete=models.CASCADE, related_name="memberships")
    site = models.ForeignKey(Site, on_delete=models.CASCADE, related_name="memberships")
    role = models.CharField(max_length=10, choices=Role.choices)

    class Meta:
        """One role for each person at each site."""

        constraints = [models.UniqueConstraint(fields=["user", "site"], name="one_role_per_member")]

    def __str__(self) -> str:
        return f"{self.user_id} is {self.role} of {self.site_id}"


class SiteMap(models.Model):
    """One version of a site's occupancy grid; the highest version is the one that holds."""

    site = models.ForeignKey(Site, on_delete=models.CASCADE, related_name="maps")
    version = models.PositiveIntegerField()
    width = models.PositiveIntegerField()
    height = models.PositiveIntegerField()
    resolution_m = models.FloatField()
    origin_x_m = models.FloatField()
    origin_y_m = models.FloatField()
    packed_cells = models.BinaryField()
    source = models.CharField(max_length=200, blank=True)
    by = models.ForeignKey(User, null=True, on_delete=models.SET_NULL, related_name="+")
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        """Versions count up from 1 at each site."""

        constraints = [models.UniqueConstraint(fields=["site", "version"], name="one_map_per_version")]

    def __str__(self) -> str:
        return f"{self.site_id} v{self.version}"

    @property
    def cells(self) -> bytes:
        """The cells, bottom row first: 0 free, 100 occupied, 255 unknown."""
        return zlib.decompress(bytes(self.packed_cells))


class Place(models.Model):
    """A named place on a site's map."""

    class Kind(models.TextChoices):
        """What the place is for."""

        DOCK = "dock"
        ROOM = "room"
        POINT = "point"

    site = models.ForeignKey(Site, on_delete=models.CASCADE, related_name="places")
    key = models.CharField(max_length=64)
    name = models.CharField(max_length=100)
    kind = models.CharField(max_length=10, choices=Kind.choices)
    x = models.FloatField()
    y = models.FloatField()
    theta = models.FloatField(default=0.0)
    label = models.JSONField(null=True)

    class Meta:
        """A place's key is its id in programs."""

        constraints = [models.UniqueConstraint(fields=["site", "key"], name="one_place_per_key")]

    def __str__(self) -> str:
        return self.name


class Device(models.Model):
    """A robot or machine: who it says it is, what people say of it, and its last word."""

    class Lifecycle(models.TextChoices):
        """Pending devices are seen and can do nothing."""

        PENDING = "pending"
        APPROVED = "approved"
        RETIRED = "retired"

    id = models.CharField(primary_key=True, max_length=64)
    site = models.ForeignKey(Site, on_delete=models.CASCADE, related_name="devices")
    lifecycle = models.CharField(max_length=10, choices=Lifecycle.choices, default=Lifecycle.PENDING)
    credential_hash = models.CharField(max_length=64, blank=True)
    broker_hash = models.CharField(max_length=160, blank=True)
    ends_before = models.DateTimeField(null=True)
    key_told_at = models.DateTimeField(null=True)
    dropped = models.BigIntegerField(default=0)

    description = models.JSONField(null=True)
    description_hash = models.CharField(max_length=64, blank=True)
    source = models.BinaryField(default=b"")
    source_type = models.CharField(max_length=40, blank=True)
    source_hash = models.CharField(max_length=64, blank=True)

    granted = models.JSONField(default=dict)

    name_override = models.CharField(max_length=100, blank=True)
    pose_override = models.JSONField(null=True)

    online = models.BooleanField(default=False)
    presence_boot = models.BigIntegerField(default=-1)
    boot = models.BigIntegerField(default=-1)
    seq = models.BigIntegerField(default=-1)
    done = models.BooleanField(default=True)
    command = models.CharField(max_length=64, blank=True)
    pose = models.JSONField(null=True)
    properties = models.JSONField(default=dict)
    first_seen_at = models.DateTimeField(null=True)
    last_seen_at = models.DateTimeField(null=True)

    class Meta:
        """Listed by site; looked through for the ones that fell silent."""

        indexes = [models.Index(fields=["site", "lifecycle"]), models.Index(fields=["online", "last_seen_at"])]

    def __str__(self) -> str:
        return self.id

    @property
    def is_locked_out(self) -> bool:
        """Tell whether its key was taken away; what was on its way still then does not bring it back."""
        return self.ends_before is not None and not self.credential_hash


class DeviceEvent(models.Model):
    """One line of a device's history."""

    device = models.ForeignKey(Device, on_delete=models.CASCADE, related_name="events")
    at = models.DateTimeField()
    kind = models.CharField(max_length=20)
    text = models.CharField(max_length=300)
    code = models.CharField(max_length=30, blank=True)
    args = models.JSONField(default=dict)
    changes = models.JSONField(default=list)
    by = models.ForeignKey(User, null=True, on_delete=models.SET_NULL, related_name="+")

    class Meta:
        """Read newest first."""

        indexes = [models.Index(fields=["device", "-at"])]

    def __str__(self) -> str:
        return self.text


class Sample(models.Model):
    """What a device's property was within one minute: its least and greatest number, and its last value as JSON.

    `minute` counts from 1970, `seq` is higher the later it was written.
    """

    device = models.ForeignKey(Device, on_delete=models.CASCADE, related_name="samples")
    property = models.CharField(max_length=64)
    minute = models.IntegerField(db_index=True)
    value = models.TextField()
    minimum = models.FloatField(null=True)
    maximum = models.FloatField(null=True)
    at_ms = models.BigIntegerField()
    seq = models.BigIntegerField(db_index=True)

    class Meta:
        """One row for each property and minute."""

        constraints = [models.UniqueConstraint(fields=["device", "property", "minute"], name="one_sample_per_minute")]

    def __str__(self) -> str:
        return f"{self.property} of {self.device_id}: {self.value}"


class SampleClock(models.Model):
    """The one row that numbers samples."""

    next = models.BigIntegerField(default=1)

    def __str__(self) -> str:
        return str(self.next)
