"""What the other apps may ask of the registry; everything else in this app is its own affair."""

from registry.alerts.alerts import Raised, end_alert, end_alerts, raise_alert, raise_alerts
from registry.alerts.buffer import flush_alerts, note_alert, note_mended
from registry.alerts.causes import AlertCode
from registry.alerts.inbox import (
    find_alert,
    list_alerts,
    list_open_alerts,
    mark_alert_seen,
    mark_all_seen,
    prune_alerts,
)
from registry.alerts.views import AlertView, alert_to_json
from registry.alerts.watch import watch_devices
from registry.broker.accounts import wait_account_change
from registry.broker.mosquitto_file import account_file
from registry.demo.devices import SITE as DEMO_SITE
from registry.demo.devices import read_demo_descriptions
from registry.demo.factory import get_demo_grid
from registry.devices.authentication import Login, Principal, check_device_password, find_ended, list_broker_hashes
from registry.devices.credentials import (
    Decided,
    NotApproved,
    reconcile_accounts,
    renew_enrolment_key,
    revoke_credential,
    rotate_credential,
)
from registry.devices.descriptions import DescriptionMessage, find_unchanged, ingest_description, ingest_descriptions
from registry.devices.enrolment import ReservedDevice, enrol_device, expect_device, reserve_device
from registry.devices.legacy_topics import TopicNotAsked, TopicTaken, confirm_topic, list_granted_topics, withdraw_topic
from registry.devices.lifecycle import (
    NotPending,
    NotRetired,
    approve_device,
    readmit_device,
    reject_device,
    retire_device,
    update_device,
)
from registry.devices.presence import count_dropped, ingest_presence, mark_stale, record_problem
from registry.devices.property_history import PointView, SeriesView, read_history
from registry.devices.queries import (
    DeliveryFacts,
    DeviceEventView,
    find_device,
    find_out,
    get_device,
    list_delivery_facts,
    list_device_events,
    list_devices,
)
from registry.devices.rows import BadDevice, NoSuchDevice
from registry.devices.samples import flush_samples, note_samples, prune_samples
from registry.devices.states import StateMessage, ingest_state, ingest_states
from registry.devices.views import DeviceView, device_to_json
from registry.live.fanout import EVERY_SITE, Message, Outage, listen, publish, publish_all, wait_wake, wake
from registry.maps.robot_map_parts import ingest_map_part
from registry.maps.robot_maps import NoRobotMap, RobotMapFacts, RobotMapView, get_robot_map, get_robot_map_facts
from registry.maps.site_maps import (
    MapChanged,
    MapVersionView,
    MapView,
    NoMap,
    compare_robot_map,
    create_site_from_map,
    get_floor_plan,
    get_map,
    get_walls,
    list_map_versions,
    restore_map,
    save_map,
    use_robot_map,
)
from registry.people.access import Access, NotAMember, find_access, require
from registry.people.sessions import Session, has_ended, session_of_socket
from registry.people.sign_in import change_password, check_sign_in, create_user, is_known
from registry.sites.sites import (
    create_site,
    get_site,
    list_places,
    list_sites,
    list_slugs,
    remove_member,
    save_places,
    set_enrolment_key,
    set_member,
    set_site_stop,
)
from registry.sites.views import PlaceView, SiteView, StopView, site_to_json
from registry.sparql.queries import QueryAnswer, run_query

__all__ = [
    "DEMO_SITE",
    "EVERY_SITE",
    "Access",
    "AlertCode",
    "AlertView",
    "BadDevice",
    "Decided",
    "DeliveryFacts",
    "DescriptionMessage",
    "DeviceEventView",
    "DeviceView",
    "Login",
    "MapChanged",
    "MapVersionView",
    "MapView",
    "Message",
    "NoMap",
    "NoRobotMap",
    "NoSuchDevice",
    "NotAMember",
    "NotApproved",
    "NotPending",
    "NotRetired",
    "Outage",
    "PlaceView",
    "PointView",
    "Principal",
    "QueryAnswer",
    "Raised",
    "ReservedDevice",
    "RobotMapFacts",
    "RobotMapView",
    "SeriesView",
    "Session",
    "SiteView",
    "StateMessage",
    "StopView",
    "TopicNotAsked",
    "TopicTaken",
    "account_file",
    "alert_to_json",
    "approve_device",
    "change_password",
    "check_device_password",
    "check_sign_in",
    "compare_robot_map",
    "confirm_topic",
    "count_dropped",
    "create_site",
    "create_site_from_map",
    "create_user",
    "device_to_json",
    "end_alert",
    "end_alerts",
    "enrol_device",
    "expect_device",
    "find_access",
    "find_alert",
    "find_device",
    "find_ended",
    "find_out",
    "find_unchanged",
    "flush_alerts",
    "flush_samples",
    "get_demo_grid",
    "get_device",
    "get_floor_plan",
    "get_map",
    "get_robot_map",
    "get_robot_map_facts",
    "get_site",
    "get_walls",
    "has_ended",
    "ingest_description",
    "ingest_descriptions",
    "ingest_map_part",
    "ingest_presence",
    "ingest_state",
    "ingest_states",
    "is_known",
    "list_alerts",
    "list_broker_hashes",
    "list_delivery_facts",
    "list_device_events",
    "list_devices",
    "list_granted_topics",
    "list_map_versions",
    "list_open_alerts",
    "list_places",
    "list_sites",
    "list_slugs",
    "listen",
    "mark_alert_seen",
    "mark_all_seen",
    "mark_stale",
    "note_alert",
    "note_mended",
    "note_samples",
    "prune_alerts",
    "prune_samples",
    "publish",
    "publish_all",
    "raise_alert",
    "raise_alerts",
    "read_demo_descriptions",
    "read_history",
    "readmit_device",
    "reconcile_accounts",
    "record_problem",
    "reject_device",
    "remove_member",
    "renew_enrolment_key",
    "require",
    "reserve_device",
    "restore_map",
    "retire_device",
    "revoke_credential",
    "rotate_credential",
    "run_query",
    "save_map",
    "save_places",
    "session_of_socket",
    "set_enrolment_key",
    "set_member",
    "set_site_stop",
    "site_to_json",
    "update_device",
    "use_robot_map",
    "wait_account_change",
    "wait_wake",
    "wake",
    "watch_devices",
    "withdraw_topic",
]
