"""The one table of who may do what, over HTTP and over sockets.

For each operation, socket and stream it has the role that it needs, and the scope of a token.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from tests.kit.files import ROOT

OPERATIONS: dict[str, dict[str, dict[str, Any]]] = json.loads((ROOT / "docs" / "openapi.json").read_text())["paths"]
"""Every operation as docs/openapi.json describes it, by its address and method."""


@dataclass(frozen=True, slots=True)
class Right:
    """What an operation asks of who calls it.

    `role` is the least role at the site that suffices; `person` is anybody who is signed in, `maker` who may make
    sites, `anybody` everybody. `scope` is what a token must be for; `session` means that no token will do.
    """

    role: str
    scope: str

    @property
    def is_of_site(self) -> bool:
        """Tell whether it is about something of one site, which others must not even know of."""
        return self.role not in ("anybody", "person", "maker")


_NAMES = {
    Right("anybody", "anybody"): "show_me sign_in",
    Right("person", "session"): "sign_out change_my_password sign_out_everywhere list_my_sessions end_my_session",
    Right("maker", "session"): "upload_site",
    Right("person", "read"): "list_sites search_library",
    Right("viewer", "session"): "list_tokens show_token create_token revoke_token",
    Right("viewer", "read"): """show_function show_function_version show_program show_compiled show_document
        show_script show_version list_versions export_version compare_versions
        wait_until_stored get_rehearsal list_rehearsals get_run list_events
        list_armed get_call list_questions plan_route plan_routes list_runs show_site list_alerts look_at_description
        list_devices export_devices show_device list_device_events show_property_history show_robot_map
        download_robot_pgm download_robot_yaml
        show_robot_cells show_difference show_rdf show_map download_pgm download_yaml show_cells list_map_versions
        show_place
        current probe sample current_of_device probe_device sample_of_device list_programs ask post_query list_things
        watch_things show_thing read_expression show_values show_value watch_value await_next_value query_action""",
    Right("viewer", "operate"): "press_stop",
    Right("operator", "operate"): """mark_seen mark_all_seen call_method cancel_call reset_stop invoke_action
        cancel_action show_operations list_findings""",
    Right("operator", "run"): """start_rehearsal cancel_rehearsal start_run pause_run resume_run cancel_run
        answer_question arm_program""",
    Right("author", "run"): """delete_program rename_program draw_script pin_version name_version
        copy_version look_at_restoring restore_version make_changes save_function
        create_program put_document put_script""",
    Right("admin", "admin"): """edit_device approve_device reject_device retire_device readmit_device
        rotate_credential revoke_credential confirm_topic withdraw_topic renew_enrolment_key reserve_device
        use_robot_map restore_map add_place edit_place remove_place patch_thing list_processes list_dead_letters
        retry_dead_letter
        drop_dead_letter show_retention set_retention""",
}
RIGHTS = {name: right for right, names in _NAMES.items() for name in names.split()}
"""What each operation asks; whoever adds an operation adds it here."""
assert len(RIGHTS) == sum(len(names.split()) for names in _NAMES.values()), "An operation stands in two rows."

SOCKETS = {
    "ws/site/<slug:slug>": Right("viewer", "session"),
    "ws/program/<uuid:program>": Right("viewer", "session"),
}
"""Who may open each socket, by its route; only who may draw is heard there, and no token opens one."""
DRAWS = Right("author", "session")
"""Whose changes are taken in a program's room."""
STREAMS = {
    "watch_things": "",
    "watch_value": "",
    "current": "?interval=1000",
    "sample": "?interval=1000",
    "current_of_device": "?interval=1000",
    "sample_of_device": "?interval=1000",
}
"""Operations that answer with a stream, and how they are asked for one; their rights stand in RIGHTS."""
STREAMED = ("text/event-stream", "multipart/x-mixed-replace")
_PERSON = Right("person", "read")
DIRECTORY = {
    "GET /.well-known/wot": Right("anybody", "anybody"),
    **dict.fromkeys(("OPTIONS /things", "OPTIONS /things/{thing}"), Right("anybody", "anybody")),
    **dict.fromkeys(("GET /things", "GET /events", "GET /events/{kind}"), _PERSON),
    **dict.fromkeys(("GET /search/{kind}", "POST /search/{kind}"), _PERSON),
    **dict.fromkeys((f"{method} /things" for method in ("POST", "PUT", "PATCH", "DELETE")), _PERSON),
    **dict.fromkeys((f"{method} /things/{{thing}}" for method in ("POST", "PUT", "DELETE")), _PERSON),
    "GET /things/{thing}": Right("viewer", "read"),
    "PATCH /things/{thing}": Right("admin", "admin"),
}
"""The directory of Things outside of /api; what a person lists and hears there is of their own sites alone.

That nothing is made or searched there is told to every person alike.
"""
