/** What came to pass between robots, where it did, on the map; a press goes to its moment. */
import { toPixels } from "@/map/plane/projection";
import { drawnAt, type Incident, isNow } from "@/scene3d/incidents";
import styles from "./IncidentMarks.module.css";

interface IncidentMarksProps {
  incidents: readonly Incident[];
  t_s: number;
  wordsOf: (incident: Incident) => string;
  onJump: (t_s: number) => void;
}

export function IncidentMarks({ incidents, t_s, wordsOf, onJump }: IncidentMarksProps) {
  return drawnAt(incidents, t_s).map((incident) => {
    if (!incident.at) return null;
    const { x, y } = toPixels(incident.at);
    const { number, kind } = incident;
    return (
      <button
        key={number}
        type="button"
        className={`${styles.mark} nopan`}
        data-kind={kind}
        data-now={isNow(incident, t_s) || undefined}
        style={{ left: x, top: y }}
        aria-label={`${number}: ${wordsOf(incident)}`}
        title={wordsOf(incident)}
        onClick={() => onJump(incident.t_s)}
      >
        {number}
      </button>
    );
  });
}
