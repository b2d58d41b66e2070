/** The session of the open program's script; it outlives the panel, so that no unfinished text is lost with a tab. */
import { useEffect, useMemo } from "react";
import { api } from "@/api/client";
import type { SharedProgram } from "../shared/sharedProgram";
import { makeId } from "../state/actions";
import { useOpenProgram } from "../state/context";
import { ScriptSession, type DrawnScript } from "./session";

const sessions = new WeakMap<SharedProgram, ScriptSession>();

export function useScriptSession(): ScriptSession {
  const { shared, program, compiled } = useOpenProgram();
  const session = useMemo(() => sessionOf(shared, program.id), [shared, program.id]);
  const script = compiled?.script;
  useEffect(() => {
    if (script !== undefined) session.show(script);
  }, [session, script]);
  return session;
}

function sessionOf(shared: SharedProgram, program: string): ScriptSession {
  const known = sessions.get(shared);
  if (known) return known;
  const made = new ScriptSession({
    draw: (request) => api.post<DrawnScript>(`/programs/${encodeURIComponent(program)}/script`, request),
    getDocument: shared.getDocument,
    apply: (edits) => shared.apply(edits),
    makeId,
  });
  sessions.set(shared, made);
  return made;
}
