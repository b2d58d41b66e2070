"""What the other apps may ask of the registry; everything else in this app is its own affair."""

from registry.alerts.alerts import Raised, end_alert, end_alerts, raise_alert, raise_alerts
from registry.alerts.buffer import flush_alerts, note_alert, note_mended
from registry.alerts.causes import AlertCode
from registry.alerts.inbox import (
    count_open_alerts,
    find_alert,
    list_alerts,
    list_open_alerts,
    mark_alert_seen,
    mark_all_seen,
    prune_alerts,
)
from registry.alerts.views import AlertView, alert_to_json
from registry.alerts.watch import watch_devices
from registry.audit.actor import VIPO, acting
from registry.audit.queries import list_server_audit
from registry.audit.record import note_act, prune_audit
from registry.bounds.pagination import FIRST, Listed, Page, take_page
from registry.bounds.slots import Claim, Slots
from registry.broker.accounts import wait_account_change
from registry.broker.mosquitto_file import account_file
from registry.dashboards.accounts import broker_of, create_token, end_readers, revoke_token
from registry.dashboards.values import list_heard_sites, read_told
from registry.demo.devices import SITE as DEMO_SITE
from registry.demo.devices import read_demo_descriptions
from registry.demo.factory import get_demo_grid
from registry.demo.workshop import Workshop, find_workshop
from registry.devices.authentication import (
    Login,
    Principal,
    check_device_password,
    find_ended,
    list_account_sites,
    list_broker_hashes,
)
from registry.devices.credentials import (
    Decided,
    NotApproved,
    reconcile_accounts,
    renew_enrolment_key,
    revoke_credential,
    rotate_credential,
    show_enrolment_key,
)
from registry.devices.descriptions import DescriptionMessage, find_unchanged, ingest_description, ingest_descriptions
from registry.devices.enrolment import NotOfSite, ReservedDevice, enrol_device, expect_device, reserve_device
from registry.devices.legacy_topics import TopicNotAsked, TopicTaken, confirm_topic, list_granted_topics, withdraw_topic
from registry.devices.lifecycle import (
    IsSimulated,
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
from registry.devices.reads import (
    PositionView,
    ReadingsView,
    get_device_names,
    get_readings,
    list_device_ids,
    list_placed,
    list_positions,
)
from registry.devices.rows import BadDevice, NoSuchDevice
from registry.devices.samples import flush_samples, prune_samples
from registry.devices.stand_ins import StandInView, list_simulated_ids, list_stand_ins, switch_stand_in
from registry.devices.states import StateMessage, ingest_state, ingest_states
from registry.devices.views import DeviceView, device_to_json
from registry.live.fanout import EVERY_SITE, Message, Outage, listen, publish, publish_all, subscribe, wait_wake, wake
from registry.maps.drawings import BadDrawing, read_brought_drawing
from registry.maps.places import PlaceChange, add_place, change_place, find_place, remove_place
from registry.maps.robot_map_parts import ingest_map_part
from registry.maps.robot_maps import (
    NoRobotMap,
    RobotMapFacts,
    RobotMapView,
    SeenMap,
    get_robot_map,
    get_robot_map_facts,
)
from registry.maps.site_maps import (
    MapChanged,
    MapVersionView,
    MapView,
    NoMap,
    find_map,
    get_floor_plan,
    get_map,
    get_map_frame,
    get_map_version,
    get_walls,
    list_map_versions,
    restore_map,
    save_map,
    use_robot_map,
)
from registry.maps.uploads import MapFiles, create_site_from_map, look_at_robot_map, look_at_upload, read_upload
from registry.maps.zones import ZoneChange, add_zone, change_zone, close_zone, find_zone, open_zone, remove_zone
from registry.people.access import Access, NotAMember, find_access, list_with_role, require
from registry.people.keyed_requests import prune_keyed_requests
from registry.people.open_sessions import drop_expired
from registry.people.passwords import draw_password
from registry.people.second_factor import reset_factor
from registry.people.sessions import Session, Standing, session_of_socket
from registry.people.sign_in import (
    change_password,
    close_account,
    create_user,
    find_person,
    is_known,
    reopen_account,
)
from registry.people.sign_on.attempts import forget_sign_ons
from registry.people.throttle import forget_attempts
from registry.people.tokens import TokenView, find_bearer, find_member, list_tokens, prune_tokens
from registry.people.wall_screens import COOKIE as WALL_COOKIE
from registry.people.wall_screens import OpenedWall, find_wall, note_wall_seen, prune_wall_screens
from registry.people.watch import Seat, watch_of_this_loop
from registry.processes.children import sigint_blocked
from registry.processes.counters import BOUNDS_S, MEASURES, Measure, count, counters_to_json, time_spent, watch_amount
from registry.processes.findings import Finding, find_trouble
from registry.processes.heartbeat_writer import HeartbeatWriter, ProcessKind
from registry.processes.heartbeats import ProcessView, list_processes, prune_processes, read_time
from registry.sites.invitations import prune_invitations
from registry.sites.mail import MailQueue, can_mail
from registry.sites.members import PersonView, list_people, remove_member, set_member
from registry.sites.quota import set_site_quota
from registry.sites.sites import (
    create_site,
    get_site,
    get_site_id,
    list_obstacles,
    list_places,
    list_sites,
    list_slugs,
    list_strange_ids,
    list_zones,
    save_places,
    set_enrolment_key,
    set_site_stop,
)
from registry.sites.views import PlaceView, SiteView, StopView, ZoneView, site_to_json
from registry.sparql.queries import QueryAnswer, run_query

__all__ = [
    "BOUNDS_S",
    "DEMO_SITE",
    "EVERY_SITE",
    "FIRST",
    "MEASURES",
    "VIPO",
    "WALL_COOKIE",
    "Access",
    "AlertCode",
    "AlertView",
    "BadDevice",
    "BadDrawing",
    "Claim",
    "Decided",
    "DeliveryFacts",
    "DescriptionMessage",
    "DeviceEventView",
    "DeviceView",
    "Finding",
    "HeartbeatWriter",
    "IsSimulated",
    "Listed",
    "Login",
    "MailQueue",
    "MapChanged",
    "MapFiles",
    "MapVersionView",
    "MapView",
    "Measure",
    "Message",
    "NoMap",
    "NoRobotMap",
    "NoSuchDevice",
    "NotAMember",
    "NotApproved",
    "NotOfSite",
    "NotPending",
    "NotRetired",
    "OpenedWall",
    "Outage",
    "Page",
    "PersonView",
    "PlaceChange",
    "PlaceView",
    "PointView",
    "PositionView",
    "Principal",
    "ProcessKind",
    "ProcessView",
    "QueryAnswer",
    "Raised",
    "ReadingsView",
    "ReservedDevice",
    "RobotMapFacts",
    "RobotMapView",
    "Seat",
    "SeenMap",
    "SeriesView",
    "Session",
    "SiteView",
    "Slots",
    "StandInView",
    "Standing",
    "StateMessage",
    "StopView",
    "TokenView",
    "TopicNotAsked",
    "TopicTaken",
    "Workshop",
    "ZoneChange",
    "ZoneView",
    "account_file",
    "acting",
    "add_place",
    "add_zone",
    "alert_to_json",
    "approve_device",
    "broker_of",
    "can_mail",
    "change_password",
    "change_place",
    "change_zone",
    "check_device_password",
    "close_account",
    "close_zone",
    "confirm_topic",
    "count",
    "count_dropped",
    "count_open_alerts",
    "counters_to_json",
    "create_site",
    "create_site_from_map",
    "create_token",
    "create_user",
    "device_to_json",
    "draw_password",
    "drop_expired",
    "end_alert",
    "end_alerts",
    "end_readers",
    "enrol_device",
    "expect_device",
    "find_access",
    "find_alert",
    "find_bearer",
    "find_device",
    "find_ended",
    "find_map",
    "find_member",
    "find_out",
    "find_person",
    "find_place",
    "find_trouble",
    "find_unchanged",
    "find_wall",
    "find_workshop",
    "find_zone",
    "flush_alerts",
    "flush_samples",
    "forget_attempts",
    "forget_sign_ons",
    "get_demo_grid",
    "get_device",
    "get_device_names",
    "get_floor_plan",
    "get_map",
    "get_map_frame",
    "get_map_version",
    "get_readings",
    "get_robot_map",
    "get_robot_map_facts",
    "get_site",
    "get_site_id",
    "get_walls",
    "ingest_description",
    "ingest_descriptions",
    "ingest_map_part",
    "ingest_presence",
    "ingest_state",
    "ingest_states",
    "is_known",
    "list_account_sites",
    "list_alerts",
    "list_broker_hashes",
    "list_delivery_facts",
    "list_device_events",
    "list_device_ids",
    "list_devices",
    "list_granted_topics",
    "list_heard_sites",
    "list_map_versions",
    "list_obstacles",
    "list_open_alerts",
    "list_people",
    "list_placed",
    "list_places",
    "list_positions",
    "list_processes",
    "list_server_audit",
    "list_simulated_ids",
    "list_sites",
    "list_slugs",
    "list_stand_ins",
    "list_strange_ids",
    "list_tokens",
    "list_with_role",
    "list_zones",
    "listen",
    "look_at_robot_map",
    "look_at_upload",
    "mark_alert_seen",
    "mark_all_seen",
    "mark_stale",
    "note_act",
    "note_alert",
    "note_mended",
    "note_wall_seen",
    "open_zone",
    "prune_alerts",
    "prune_audit",
    "prune_invitations",
    "prune_keyed_requests",
    "prune_processes",
    "prune_samples",
    "prune_tokens",
    "prune_wall_screens",
    "publish",
    "publish_all",
    "raise_alert",
    "raise_alerts",
    "read_brought_drawing",
    "read_demo_descriptions",
    "read_history",
    "read_time",
    "read_told",
    "read_upload",
    "readmit_device",
    "reconcile_accounts",
    "record_problem",
    "reject_device",
    "remove_member",
    "remove_place",
    "remove_zone",
    "renew_enrolment_key",
    "reopen_account",
    "require",
    "reserve_device",
    "reset_factor",
    "restore_map",
    "retire_device",
    "revoke_credential",
    "revoke_token",
    "rotate_credential",
    "run_query",
    "save_map",
    "save_places",
    "session_of_socket",
    "set_enrolment_key",
    "set_member",
    "set_site_quota",
    "set_site_stop",
    "show_enrolment_key",
    "sigint_blocked",
    "site_to_json",
    "subscribe",
    "switch_stand_in",
    "take_page",
    "time_spent",
    "update_device",
    "use_robot_map",
    "wait_account_change",
    "wait_wake",
    "wake",
    "watch_amount",
    "watch_devices",
    "watch_of_this_loop",
    "withdraw_topic",
]
