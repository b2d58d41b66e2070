"""The tables of the registry: people, sites, what was done there, maps, devices, alerts and processes."""

from registry.models.alerts import DeviceAlert as DeviceAlert
from registry.models.audit import AuditLine as AuditLine
from registry.models.devices import Device as Device
from registry.models.devices import DeviceEvent as DeviceEvent
from registry.models.devices import Sample as Sample
from registry.models.devices import SampleClock as SampleClock
from registry.models.devices import ThingEvent as ThingEvent
from registry.models.devices import TopicClaim as TopicClaim
from registry.models.invitations import Invitation as Invitation
from registry.models.maps import Place as Place
from registry.models.maps import RobotMap as RobotMap
from registry.models.maps import RobotMapDraft as RobotMapDraft
from registry.models.maps import RobotMapPart as RobotMapPart
from registry.models.maps import SiteMap as SiteMap
from registry.models.people import OpenSession as OpenSession
from registry.models.people import SignInFailure as SignInFailure
from registry.models.people import User as User
from registry.models.people import UserManager as UserManager
from registry.models.processes import Heartbeat as Heartbeat
from registry.models.requests import KeyedRequest as KeyedRequest
from registry.models.second_factor import RecoveryCode as RecoveryCode
from registry.models.second_factor import SecondFactor as SecondFactor
from registry.models.sites import Membership as Membership
from registry.models.sites import Site as Site
from registry.models.tokens import ApiToken as ApiToken
from registry.models.wall_screens import WallScreen as WallScreen
