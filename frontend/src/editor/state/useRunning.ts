/** The steps of the open program that runs are at. */
import { useEffect } from "react";
import { useOpenRuns } from "@/api/queries";
import type { OpenProgram } from "./context";
import { useScreen } from "./screen";

export function useRunning({ site, program }: Pick<OpenProgram, "site" | "program">): void {
  const { data } = useOpenRuns(site.slug);
  useEffect(() => {
    const here = (data ?? []).filter((run) => run.program.id === program.id && run.status === "running");
    const running = here.flatMap((run) =>
      Object.entries(run.steps).flatMap(([id, { status }]) => (status === "running" ? [id] : [])),
    );
    useScreen.setState({ running });
  }, [data, program.id]);
}
