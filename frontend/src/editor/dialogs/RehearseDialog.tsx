/** The open program is rehearsed as it is drawn, under conditions that are chosen. */
import { useNavigate } from "react-router-dom";
import { RehearseDialog as RehearseProgram } from "@/shell/start/RehearseDialog";
import { useUi } from "../state/ui";
import { useStartable } from "./startable";

export function RehearseDialog() {
  const about = useStartable();
  const navigate = useNavigate();
  return (
    <RehearseProgram
      opened={useUi((ui) => ui.dialog === "rehearse")}
      about={about}
      onClose={() => useUi.setState({ dialog: null })}
      onStarted={(id) => void navigate(`/programs/${about.program.id}/simulate/${id}`)}
    />
  );
}
