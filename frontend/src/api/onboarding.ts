/** Bringing devices in: what they are set up with, and what VIPO makes of a description. */

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

export interface DescriptionFault {
  text: string;
  /** From 1; 0 where there is none. */
  line: number;
  column: number;
  path: string;
}

export interface DescriptionLook {
  form: "turtle" | "n-triples" | "json-ld" | "td" | "paper" | null;
  faults: DescriptionFault[];
  notes: string[];
  description: { id: string; name: string; kind: "machine" | "robot"; methods: { name: string }[] } | null;
  turtle: string;
}
