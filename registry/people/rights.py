"""Who may do what: the one table of it, by what people call it, with every operation of the API.

It makes the table that admins see and the one of docs/administration.md, and the tests try every operation by it, as
each role, as strangers and with tokens. The operations themselves do not read it: each says with `require` what it
needs, so that the table is held to what really happens, and not to itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from registry.people.roles import ROLES

Role = Literal["anybody", "wall", "person", "maker", "viewer", "commenter", "operator", "author", "admin"]
Scope = Literal["anybody", "session", "read", "operate", "run", "admin"]


@dataclass(frozen=True, slots=True)
class Right:
    """What an operation asks of who calls it.

    `role` is the least role at the site that suffices; `person` is anybody who is signed in, `maker` who may make
    sites, `wall` a wall screen alone, `anybody` everybody. `scope` is what a token must be for; `session` means that no
    token will do.
    """

    role: Role
    scope: Scope

    @property
    def is_of_site(self) -> bool:
        """Tell whether it is about something of one site, which others must not even know of."""
        return self.role not in ("anybody", "wall", "person", "maker")


@dataclass(frozen=True, slots=True)
class Deed:
    """Something that people do, by a word for its sentence, and the operations that do it."""

    name: str
    right: Right
    operations: tuple[str, ...]

    @property
    def roles(self) -> tuple[str, ...]:
        """The roles of a site that may do it; none where it is not about a site."""
        return tuple(ROLES[ROLES.index(self.right.role) :]) if self.right.is_of_site else ()


def _deed(name: str, role: Role, scope: Scope, operations: str) -> Deed:
    return Deed(name, Right(role, scope), tuple(operations.split()))


DEEDS = (
    _deed(
        "look",
        "viewer",
        "read",
        """
        list_asked_reviews
        show_review
        show_review_rule
        show_function
        list_function_versions
        compare_function
        list_function_uses
        show_program_origin
        show_function_version
        show_program
        show_compiled
        show_document
        show_script
        show_version
        list_versions
        export_version
        compare_versions
        wait_until_stored
        get_rehearsal
        export_rehearsal
        list_rehearsals
        list_paces
        list_measurements
        get_run
        list_events
        show_timeline
        list_version_runs
        list_armed
        get_call
        list_open_calls
        list_questions
        plan_route
        plan_routes
        list_runs
        show_site
        list_alerts
        look_at_description
        list_devices
        export_devices
        show_device
        list_device_events
        show_property_history
        show_robot_map
        download_robot_pgm
        download_robot_yaml
        show_robot_cells
        show_difference
        show_rdf
        show_map
        download_pgm
        download_yaml
        download_nav2_masks
        download_lif
        download_building
        show_cells
        list_map_versions
        show_map_version
        show_version_cells
        show_place
        show_zone
        current
        probe
        sample
        current_of_device
        probe_device
        sample_of_device
        list_programs
        ask
        post_query
        list_things
        watch_things
        show_thing
        read_expression
        show_values
        show_value
        watch_value
        await_next_value
        query_action
        list_threads
        show_thread
        mark_thread_read
        list_tests
        export_tests
        show_test
        show_version_tests
        show_test_run
        compare_function_sides
        list_awaited_admissions
        list_zone_costs
        get_floor_check
        get_floor_use
        """,
    ),
    _deed("stop", "viewer", "operate", "press_stop"),
    _deed(
        "own",
        "viewer",
        "session",
        """
        list_tokens
        show_token
        create_token
        revoke_token
        list_members
        leave_site
        """,
    ),
    _deed(
        "comment",
        "commenter",
        "run",
        """
        list_people_to_mention
        start_thread
        answer_thread
        change_thread
        change_comment
        delete_comment
        comment_on_run
        """,
    ),
    _deed(
        "operate",
        "operator",
        "operate",
        """
        mark_seen
        mark_all_seen
        call_method
        cancel_call
        reset_stop
        invoke_action
        cancel_action
        show_operations
        list_findings
        """,
    ),
    _deed(
        "run",
        "operator",
        "run",
        """
        start_rehearsal
        cancel_rehearsal
        start_run
        pause_run
        resume_run
        cancel_run
        answer_question
        arm_program
        run_tests
        take_pace
        drop_pace
        begin_stand_in
        end_stand_in
        let_robot_in
        open_zone
        close_zone
        add_obstacle
        move_obstacle
        remove_obstacle
        remove_obstacles
        """,
    ),
    _deed("ask_review", "operator", "run", "ask_for_review"),
    _deed("review", "operator", "session", "give_verdict"),
    _deed(
        "draw",
        "author",
        "run",
        """
        delete_program
        rename_program
        draw_script
        pin_version
        name_version
        copy_version
        look_at_restoring
        restore_version
        make_changes
        save_function
        fork_function
        change_function
        create_program
        put_document
        put_script
        look_at_promotion
        promote_program
        add_test
        look_at_test
        show_first_text
        import_tests
        write_test
        delete_test
        say_change_is_meant
        """,
    ),
    _deed(
        "equip",
        "admin",
        "admin",
        """
        edit_device
        approve_device
        reject_device
        retire_device
        readmit_device
        rotate_credential
        revoke_credential
        confirm_topic
        withdraw_topic
        renew_enrolment_key
        reserve_device
        use_robot_map
        restore_map
        add_place
        edit_place
        upload_map
        look_at_map
        read_drawing
        read_map_files
        remove_place
        add_zone
        edit_zone
        remove_zone
        patch_thing
        list_remedies
        """,
    ),
    _deed(
        "keep",
        "admin",
        "admin",
        """
        list_processes
        list_dead_letters
        retry_dead_letter
        drop_dead_letter
        show_retention
        set_retention
        list_audit
        export_audit
        set_review_rule
        """,
    ),
    _deed(
        "people",
        "admin",
        "session",
        """
        show_member
        change_member
        remove_member
        list_invitations
        make_invitation
        revoke_invitation
        list_wall_screens
        make_wall_screen
        revoke_wall_screen
        reset_second_factor
        show_factor_rule
        set_factor_rule
        """,
    ),
    _deed(
        "come",
        "anybody",
        "anybody",
        """
        show_me
        sign_in
        look_at_invitation
        join_as_new
        open_wall_screen
        list_sign_on_providers
        begin_provider_sign_on
        finish_provider_sign_on
        end_sessions_of_provider
        """,
    ),
    _deed(
        "account",
        "person",
        "session",
        """
        sign_out
        change_my_password
        sign_out_everywhere
        list_my_sessions
        end_my_session
        accept_invitation
        show_second_factor
        begin_second_factor
        confirm_second_factor
        renew_recovery_codes
        turn_off_second_factor
        list_my_sign_ons
        begin_linking
        remove_my_sign_on
        show_my_mail
        choose_my_mail
        change_my_name
        """,
    ),
    _deed(
        "find",
        "person",
        "read",
        """
        list_sites
        search_library
        list_rights
        """,
    ),
    _deed("make_site", "maker", "session", "upload_site"),
)
"""What the table on the screen shows comes first, in its order; then what is about no site."""
RIGHTS = {operation: deed.right for deed in DEEDS for operation in deed.operations}
"""What each operation asks; whoever adds an operation adds it to a deed."""
assert len(RIGHTS) == sum(len(deed.operations) for deed in DEEDS), "An operation stands in two deeds."
