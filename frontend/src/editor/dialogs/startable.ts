/** The open program as the dialogs that start it take it. */
import type { Startable } from "@/shell/start/startable";
import { useOpenProgram } from "../state/context";

export function useStartable(): Startable {
  const { program, site, document, compiled, devices, plan, shared } = useOpenProgram();
  const places = plan?.places ?? [];
  return { program, site, document, compiled, devices, places, version: null, stored: () => shared.stored() };
}
