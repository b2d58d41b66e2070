"""The English sentences for what can be wrong with what a device sends, or was mended in it, by their codes; pure."""

from __future__ import annotations

from collections.abc import Mapping

_OUTSIDE: Mapping[str, str] = {
    "too_many_bytes": "{it} has {bytes} bytes; {most} is the most.",
    "markup": "The description is RDF/XML or HTML, which is not accepted. Send {accepted}.",
    "not_utf8": "{it} is not UTF-8. Save or send it as UTF-8.",
    "nul": "The description holds the character NUL. Remove it.",
    "empty": "The description is empty.",
    "half_pair": "The description holds half of a surrogate pair. Remove it.",
    "no_form": "There is no form {form!r}. Ask for {forms}.",
    "other_id": "The description is of {said!r}, but it came on the topic of {device!r}. Use one id.",
    "context_unknown": (
        "The description's context {named!r} is not known here. Use {known!r}, or write its prefixes out."
    ),
    "context_import": "The description imports a JSON-LD context. Write the context out.",
    "context_meaning": "The description's context gives the prefix {prefix} another meaning than {meaning}.",
    "context_within": "The description has a context within a context. Put all prefixes at its top.",
    "term_twice": "The description says the same term twice, under two prefixes.",
}
_JSON: Mapping[str, str] = {
    "json_value": (
        "{it} is not JSON: a value is missing here, or is none: a number such as 1.5, true, false, null, a text in "
        "double quotes, a list or an object."
    ),
    "json_key": (
        "{it} is not JSON: a key in double quotes is expected here. There is no comma behind the last entry, and JSON "
        "has no comments."
    ),
    "json_colon": "{it} is not JSON: a colon is missing between a key and its value.",
    "json_comma": "{it} is not JSON: a comma or a closing bracket is missing just before this place.",
    "json_trailing": "{it} is not JSON: there is no comma behind the last entry. Remove it.",
    "json_string": "{it} is not JSON: the text that begins here has no closing quote.",
    "json_control": "{it} is not JSON: a text holds a line break or a tab; write \\n or \\t instead.",
    "json_escape": "{it} is not JSON: write a backslash within a text as two, \\\\.",
    "json_extra": "{it} is not JSON: something follows behind its end. Remove it.",
    "json_unclear": "{it} is not JSON: {reason}.",
    "json_deep": "{it} is nested more than {most} levels deep.",
    "json_twice": "{it} names the key {key!r} twice. Remove one.",
    "json_constant": "{it} holds {value}, which is not a number of JSON.",
    "json_large": "{it} holds a number that is too large: {value}.",
    "json_no_text": "{it} holds a character that is not text (a control character or half of a surrogate pair).",
    "no_object": "{it} is not a JSON object.",
}
_RDF: Mapping[str, str] = {
    "rdf_prefix": (
        "The description is not RDF (Turtle, N-Triples or JSON-LD): The prefix {prefix} has not been declared. Begin "
        "the text with '@prefix {prefix} <…> .'; docs/protocol.md and registry/demo/devices/ have those that VIPO "
        "knows. The paper's message begins with a line 'id: …' instead."
    ),
    "rdf_commas": (
        "The description is not RDF (Turtle, N-Triples or JSON-LD): a comma stands where it cannot. The members of a "
        "list, ( 1.5 2 3 ), have blanks between them and no commas."
    ),
    "rdf_predicate": (
        "The description is not RDF (Turtle, N-Triples or JSON-LD): {said} stands where a predicate such as dct:title "
        "is needed. A list stands in round brackets, ( 1 2 3 )."
    ),
    "rdf_dot": (
        "The description is not RDF (Turtle, N-Triples or JSON-LD): a statement ends without a dot, or goes on without "
        "a semicolon. Look just before it for a missing dot, semicolon, quote or bracket."
    ),
    "rdf_end": (
        "The description is not RDF (Turtle, N-Triples or JSON-LD): it ends too early. Look just before it for a "
        "missing dot, semicolon, quote or bracket."
    ),
    "rdf_subject": (
        "The description is not RDF (Turtle, N-Triples or JSON-LD): {said} cannot begin a statement; write <urn:…> or "
        "a prefix and a name. The paper's message begins with a line 'id: …', JSON with a brace."
    ),
    "rdf_syntax": (
        "The description is not RDF (Turtle, N-Triples or JSON-LD): {reason}. Look just before it for a missing dot, "
        "semicolon, quote, bracket or prefix."
    ),
    "rdf_deep": "The description is not RDF that is accepted: it is nested over {most} deep.",
    "json_ld": "The description is not JSON-LD: {reason}.",
    "rdf_statements": "The description makes statements about statements (RDF 1.2). Keep to RDF 1.1.",
    "rdf_literals": "The description holds XML or HTML literals. Use plain text.",
    "rdf_triples": "The description has {count} triples; {most} is the most.",
    "rdf_no_kind": (
        "The description names no vipo:Machine or vipo:Robot. It needs exactly one, such as '<urn:vipo:device:lamp01> "
        'a vipo:Machine\' in Turtle or "@type": "vipo:Machine" in JSON, where vipo: is urn:vipo:ns#.'
    ),
    "rdf_other_kinds": (
        "The description names no vipo:Machine or vipo:Robot. It needs exactly one, such as '<urn:vipo:device:lamp01> "
        'a vipo:Machine\' in Turtle or "@type": "vipo:Machine" in JSON, where vipo: is urn:vipo:ns#. It speaks of '
        "{kinds}."
    ),
    "rdf_no_vipo": (
        'The description says {kind}, but not what vipo: is. JSON-LD begins with "@context": "urn:vipo:context", a '
        'Thing Description with "@context": ["https://www.w3.org/2022/wot/td/v1.1", {{"vipo": "urn:vipo:ns#"}}].'
    ),
    "rdf_kinds": "The description names more than one vipo:Machine or vipo:Robot. It needs exactly one.",
    "rdf_no_id": 'The description needs the device\'s id: dct:identifier "lamp01".',
    "rdf_more": "The description gives {key} more than once.",
    "rdf_list": ('The description needs one list for {key}: ( … ) in Turtle, {{"@list": […]}} in JSON-LD.'),
    "rdf_text": "The description needs text for {key}.",
    "rdf_number": "The description needs a number for {key}.",
    "rdf_whole": "The description needs a whole number for {key}.",
    "rdf_truth": "The description needs true or false for {key}.",
    "rdf_location": "The description needs vipo:location ( x y z theta ) in metres and radians.",
    "rdf_size": "The description needs vipo:size ( x y z ) in metres.",
}
_FIELDS: Mapping[str, str] = {
    "need_id": 'The description needs the device\'s id for {key}, such as "lamp01".',
    "need_text": "The description needs text in quotes for {key}.",
    "need_number": "The description needs a number for {key}.",
    "need_whole": "The description needs a whole number for {key}.",
    "need_truth": "The description needs true or false for {key}.",
    "need_numbers": "The description needs a list of numbers for {key}, such as [1.5, 2].",
    "need_words": 'The description needs a list of texts for {key}, such as ["red", "green"].',
    "need_object": "The description needs an object for {key}.",
    "need_list": "The description needs a list for {key}.",
    "need_pose": "The description needs [x, y, z, theta] in metres and radians for {key}.",
    "need_size": "The description needs [x, y, z] in metres for {key}.",
    "need_size_word": "The description needs small, medium, large or [x, y, z] in metres for {key}.",
    "need_kind": "The description needs machine or robot for {key}.",
    "need_td_kind": "The description needs either vipo:Machine or vipo:Robot for {key}.",
    "need_td_id": "The description needs urn:vipo:device:<the device's id>, or the id as dct:identifier, for {key}.",
    "need_mqtt": "The description needs a form for MQTT: an href with the device's own topic.",
    "said_twice": "The description says {meant} twice.",
    "value_type": ("The description has a value of type {type}; use number, string or boolean, or say vipo:type."),
    "two_topics": "The description names the topic {named!r} and links to {linked!r}; use one.",
    "td_missing": "The TD schema says: {name!r} is a required property.",
    "td_missing_such": "The TD schema says: {name!r} is a required property. Such as {example}.",
    "td_type": "The TD schema says: {value} is not of type {type}.",
    "td_choice": "The TD schema says: {value} is not one of {choices}.",
    "td_empty": "The TD schema says: {value} should be non-empty.",
    "td_unclear": "The TD schema says: {reason}.",
}
_PAPER: Mapping[str, str] = {
    "paper_line": "The description has a line that is not `key: value`: {said!r}.",
    "paper_value": (
        "The description has a value of {key} that cannot be read: {said!r}. Write a number as 1.5, a list as [1, 2], "
        "a text in double quotes."
    ),
    "paper_no_value": "The description needs a value for {key}.",
    "paper_under": (
        "The description has a line that is set in under {key}, which holds no list. Begin it where {key} begins."
    ),
    "paper_less": "The description has a line that is set in less than the lines before it.",
    "paper_name": "The description needs name as the first line of each of its {section}.",
    "mended_colon": "Put a colon behind {key}.",
    "mended_key": "Read {written!r} as {key}.",
    "mended_quotes": "Put the value of {key} in quotes: {value!r}.",
    "left_key": "Left out {key!r}, which means nothing here.",
    "left_term": "Left out {key!r}, which means nothing here. Perhaps {like} is meant.",
    "left_value": "Left out the value of {name}: values come on up/state.",
    "left_image": "Left out imgUrl {image!r}: only an address with http:// or https:// can be shown.",
    "own_topic": "Commands for {method} come on {topic}, not on the ROS topic {said!r}.",
}
_MEANING: Mapping[str, str] = {
    "location_far": "Its location is not within a million metres: {said}.",
    "size_range": "Its size must be three lengths between 0 and 100 metres: {said}.",
    "capacity_range": "Its capacity must lie between 0 and 1000 objects.",
    "radius_range": "Its radius must lie between 0 and 10 m.",
    "speed_range": "Its speed must lie between 0.001 and 20 m/s, or be 0 if it tells none.",
    "robot_radius": "A robot must give its radius.",
    "bad_id": "Its id must be 1 to 64 letters, digits, '_', '.' or '-': {id!r}.",
    "name_length": "Its name must have 1 to 100 characters.",
    "description_length": "Its description must have at most 1000 characters.",
    "image_length": "Its image's address must have at most 500 characters.",
    "control_characters": "Its name, description and titles must not hold control characters.",
    "image_address": "Its image must be an address that begins with http:// or https://, or be left out.",
    "class_word": "Its class must be a word of at most 64 letters, digits, '_', '.' or '-'.",
    "site_word": "Its site must be a word of at most 64 letters, digits, '_', '.' or '-'.",
    "objects_words": "What it gives and takes must be words of letters, digits, '_', '.' or '-', 64 at most.",
    "many_properties": "It has more than {most} properties.",
    "many_methods": "It has more than {most} methods.",
    "many_parameters": "Its method {method!r} has more than {most} parameters.",
    "topic_twice": "Two of its methods name the topic {topic}; a device could not tell them apart.",
    "property_title": "Its property {name!r} has a title of more than 100 characters.",
    "method_title": "Its method {method!r} has a title of more than 100 characters.",
    "message_type": (
        "Its method {method!r} has a message type that is no word of at most 64 letters, digits, '_', '.' or '-'."
    ),
    "method_credential": (
        "It has a method called credential, by which VIPO tells a device its new key; give it another name."
    ),
    "property_nameless": "One of its properties has no name.",
    "method_nameless": "One of its methods has no name.",
    "parameter_nameless": "One of its methods has a parameter without a name.",
    "property_name": "The property name {name!r} must be letters, digits and '_', beginning with a letter.",
    "method_name": "The method name {name!r} must be letters, digits and '_', beginning with a letter.",
    "parameter_name": "The parameter name {name!r} must be letters, digits and '_', beginning with a letter.",
    "property_twice": "It names the property {name!r} twice.",
    "method_twice": "It names the method {name!r} twice.",
    "parameter_twice": "It names the parameter {name!r} twice.",
    "unknown_type": "{name!r} has the unknown type {type!r}; use {types}.",
    "no_unit": "{name!r} has a unit that is not a QUDT unit's short name, such as DEG_C: {unit!r}.",
    "limits_order": "{name!r} has limits that are not numbers in order.",
    "many_options": "{name!r} has more than 64 options, or one of more than 64 characters.",
    "odd_option": "{name!r} has an option that is empty, comes twice, or holds control characters.",
    "topic_foreign": "Its method {method!r} names a topic that is not its own; use {own}.",
    "topic_fixed": (
        "Its method {method!r} names a topic of its own choice, but {method} is always told on the device's; use {own}."
    ),
    "topic_long": "Its method {method!r} names a topic of more than {most} characters; use {own}.",
    "topic_levels": (
        "Its method {method!r} names a topic that is not levels of letters, digits and _ . @ = ~ - with / between; "
        "use {own}."
    ),
}
_STATES: Mapping[str, str] = {
    "presence_said": "Presence needs `s`: online or offline.",
    "old_start": (
        "It comes as start {said} (`boot`), but start {known} was heard before: what it says is left aside. `boot` has "
        "to be higher at each start. Set its clock or its count; for another board in its place give the device a new "
        "key; of two devices with this id give one another id."
    ),
    "old_state": (
        "It says state {seq} of start {boot}, but state {last} of start {start} was heard before: it is left aside, "
        "and the device counts as offline. `boot` has to be higher at each start, and `seq` at each state of it."
    ),
    "state_done": "State needs `done`: true or false.",
    "answer_id": "An answer needs `id`, the command's.",
    "answer_status": "An answer needs `st`: one of {choices}.",
    "need_count": "The message needs `{key}`: a whole number from 0.",
    "text_length": "`{key}` must be text of at most {most} characters.",
    "state_location": "`loc` must be [x, y, z, theta]: metres and radians.",
    "many_values": "`{key}` must be an object of at most {most} values.",
    "no_plain_value": "`{key}` holds {name!r}, which is not a plain value with a short name.",
    "value_length": "`{key}` holds a text of more than {most} characters: {name!r}.",
    "flood": "too many messages: some were dropped",
    "no_room": "too many messages wait for it: some were dropped",
    "many_subscriptions": "more than {most} subscriptions: some were refused",
    "many_retained": "more than {most} retained topics: some were not kept",
    "odd_packet": "a packet that no client sends ended its connection",
    "giant_packet": "a packet of more than {most} bytes ended its connection",
    "no_topic": "a message without a proper topic ended its connection",
    "unreleased": "too many messages of QoS 2 that it does not release ended its connection",
    "no_packet_id": "a packet without a number ended its connection",
    "foreign_topic": "not its own topic: {topic}",
}
_MAPS: Mapping[str, str] = {
    "map_parts_differ": "The parts of the map tell of different sizes, places or numbers of parts.",
    "map_parts_missing": "The map has {count} of its {parts} parts.",
    "map_turned": "The map is turned; `origin` must have theta 0.",
    "map_not_packed": "The cells are not packed with zlib.",
    "map_cell_count": "The map has not the {wanted} cells that its size says.",
    "map_cell": "A cell must be 0 to 100, or 255 for unknown.",
    "map_whole": "`{key}` must be a whole number from {least} to {most}.",
    "map_size": "`size` must be [width, height]: cells, from 1 to {most}.",
    "map_cells": "The map has more than {most} cells.",
    "map_resolution": "`resolution` must be from 0.001 to 10 metres.",
    "map_origin": "`origin` must be [x, y, theta]: metres and radians.",
    "map_base64": "`cells` must be text in base64.",
    "map_of_machine": "Only a robot sends a map, and this device describes itself as a machine.",
    "map_bytes": "The map has more than {most} packed bytes. Send a coarser or smaller one.",
    "map_too_often": "Whole maps come too fast; one every {seconds} s is enough.",
}
_JOINING: Mapping[str, str] = {
    "topic_taken": (
        "Its method {method} names the topic {topic}, which another device asks for or has. Use a topic of its own, or "
        "let an admin take the other device out."
    ),
    "topic_of_site": (
        "Its method {method} names the topic {topic}. Several sites share this server: new topics of this one begin "
        "with {site}/, such as {site}/{topic}."
    ),
    "id_of_site": (
        "{device} cannot be a new id here. Several sites share this server: new ids of this one begin with {site}., "
        "such as {site}.{device}."
    ),
    "id_of_place": (
        "{device} has the id of the place “{place}”, so robots that are sent to one would drive to the other. Remove "
        "the place and add it anew, which gives it another id, or give the device another id."
    ),
    "no_site": "There is no site {site!r} that the device could join, and no default site.",
    "device_id": "A device's id must be 1 to 64 letters, digits, '_', '.' or '-', and not 'server', '.' or '..'.",
    "knock_key": "An enrolment needs `key`: {least} to {most} printable ASCII characters, made at random.",
    "newcomers": "{most} devices wait for approval at this site already. Decide about some of them first.",
    "reserved_before": (
        "{by} added {device} at {at} (UTC), and has its key; it has not come yet. Ask them for the key, choose another "
        "id, or make another key: then the first one ends."
    ),
    "reserved_just_now": (
        "{by} was told a key of {device} at {at} (UTC), seconds ago. Ask for that one, or wait ten seconds: another "
        "key would end it."
    ),
    "knocked_before": (
        "{device} brought a key of its own at {at} (UTC), and has not described itself yet. Wait until it does, choose "
        "another id, or make another key: then its own one ends."
    ),
    "knock_revoked": (
        "{device} wanted to enrol, whose key was revoked. Give it a new key, or retire it and let it come back."
    ),
    "knock_foreign": (
        "Somebody wanted to enrol as {device}, which is known with another key. If it is the same device, reject or "
        "retire it first and let it come back."
    ),
}
SENTENCES: Mapping[str, str] = {
    **_OUTSIDE,
    **_JSON,
    **_RDF,
    **_FIELDS,
    **_PAPER,
    **_MEANING,
    **_STATES,
    **_MAPS,
    **_JOINING,
}
"""English for each code; what stands in braces are its arguments."""
