/** The address of a rehearsal at a moment: who may see the site may open it. */
import { useEffect } from "react";
import { useSearchParams } from "react-router-dom";

const MOMENT = "t";
/** So long nothing has changed before the address is another. */
const REST_MS = 400;

/** The moment that an address names, in seconds; 0 where it names none. */
export function momentIn(search: URLSearchParams): number {
  const said = Number(search.get(MOMENT));
  return Number.isFinite(said) && said > 0 ? said : 0;
}

export const momentWritten = (t_s: number): string => String(Math.round(t_s * 10) / 10);

export function addressOf(program: string, rehearsal: string, t_s: number): string {
  return `${location.origin}/programs/${program}/simulate/${rehearsal}?${MOMENT}=${momentWritten(t_s)}`;
}

/** While the recording rests, the page's own address names the moment, so that it can be copied or opened again. */
export function useMomentInAddress(t_s: number, playing: boolean): void {
  const [search, setSearch] = useSearchParams();
  const said = search.get(MOMENT);
  useEffect(() => {
    const written = t_s > 0 ? momentWritten(t_s) : null;
    if (playing || written === said) return;
    const timer = setTimeout(
      () => setSearch(written === null ? {} : { [MOMENT]: written }, { replace: true, preventScrollReset: true }),
      REST_MS,
    );
    return () => clearTimeout(timer);
  }, [t_s, playing, said, setSearch]);
}
