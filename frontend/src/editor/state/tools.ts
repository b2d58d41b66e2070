/** What can be drawn with: the kinds of steps, and zones. */
import { STEP_KINDS, type Kind } from "@/program/kinds";

export const ZONE_TOOL = "zone";

const ZONE: Kind = { kind: ZONE_TOOL, icon: "zone", family: "note", shape: "note", key: "Z", forms: [] };

export const TOOLS: readonly Kind[] = [...STEP_KINDS, ZONE];
