/** The button for one parameter more. */
import { Button } from "@mantine/core";
import { Plus } from "lucide-react";
import type { Parameter } from "@/program/document/document";
import { useOpenProgram } from "../../state/context";
import classes from "../../panel.module.css";

export function AddParameter({
  taken,
  disabled,
  onAdd,
}: {
  taken: readonly Parameter[];
  disabled: boolean;
  onAdd: (parameter: Parameter) => void;
}) {
  const { t } = useOpenProgram();
  const names = taken.map((each) => each.name);
  const fresh = Array.from({ length: names.length + 1 }, (_, index) => t("call.fresh", { count: index + 1 }));
  const name = fresh.find((each) => !names.includes(each)) ?? "";
  return (
    <Button
      variant="default"
      size="xs"
      className={classes.between}
      leftSection={<Plus size={14} aria-hidden="true" />}
      disabled={disabled}
      onClick={() => onAdd({ name, type: "number" })}
    >
      {t("call.add_parameter")}
    </Button>
  );
}
