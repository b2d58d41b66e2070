/** Bringing devices in: what they are set up with, and what VIPO makes of a description. */
import type { Fault } from "./faults";

export interface ExpectedDevice {
  id: string;
  site: string;
  /** Its key, told this once. */
  credential: string;
  /** `mqtt://host:port/` or `mqtts://…`; may be empty. */
  broker: string;
}

export interface Door {
  site: string;
  join_key: string;
  broker: string;
}

export interface DescriptionLook {
  form: "turtle" | "n-triples" | "json-ld" | "td" | "paper" | null;
  faults: Fault[];
  /** What was mended or left out. */
  mended: Fault[];
  description: { id: string; name: string; kind: "machine" | "robot"; methods: { name: string }[] } | null;
  turtle: string;
}
