/** What is wrong with something that a device sends, or was mended in it. */
export interface Fault {
  /** The English sentence. */
  text: string;
  /** From 1; 0 where there is none. */
  line: number;
  column: number;
  /** Into JSON; may be empty. */
  path: string;
  /** What the sentence is made of; empty where it stands for itself. */
  code: string;
  args: Record<string, number | string>;
}

/** The faults among the arguments of a line of history, an alert or a refusal; older ones have none. */
export function faultsOf(args: Readonly<Record<string, unknown>> | undefined): Fault[] {
  return Array.isArray(args?.faults) ? (args.faults as Fault[]) : [];
}
