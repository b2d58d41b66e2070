"""What the record of a site tells of: each code has a kind, by which people look for it."""

from __future__ import annotations

from typing import Literal, get_args

Kind = Literal[
    "roles", "invitations", "tokens", "wall_screens", "runs", "stops", "devices", "programs", "map", "sign_in"
]
KINDS: tuple[Kind, ...] = get_args(Kind)

_CODES: dict[Kind, str] = {
    "roles": "role_changed access_end_set member_added member_removed member_left joined renamed",
    "invitations": "invitation_made invitation_revoked",
    "tokens": "token_made token_revoked",
    "wall_screens": "wall_screen_made wall_screen_revoked",
    "runs": """run_started run_cancelled run_started_in_emergency armed_run_not_approved armed_run_unreadable
        robot_let_in zone_opened zone_closed obstacle_added obstacles_removed keeping_set""",
    "stops": "stop_pressed stop_reset",
    "devices": """device_asked device_turned_away device_approved device_rejected device_retired
        device_readmitted device_key_given device_key_revoked enrolment_key_renewed calibration_taken
        calibration_dropped device_simulated device_real_again""",
    "programs": """program_deleted comment_deleted review_rule_set review_asked review_approved review_changes
        review_withdrawn""",
    "map": "map_published place_added place_changed place_removed zone_added zone_changed zone_removed",
    "sign_in": """sign_in_locked second_factor_on second_factor_off second_factor_reset second_factor_demanded
        sign_on_linked sign_on_unlinked sign_on_refused sign_on_account_made sign_on_ended""",
}
KIND_OF: dict[str, Kind] = {code: kind for kind, codes in _CODES.items() for code in codes.split()}
