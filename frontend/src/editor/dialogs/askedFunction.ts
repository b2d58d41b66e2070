/** `?import=<id>` in the address: the library page sent somebody here with one of its functions. */
import { useSearchParams } from "react-router-dom";

export function useAskedFunction(canEdit: boolean) {
  const [address, setAddress] = useSearchParams();
  const asked = canEdit ? address.get("import") : null;
  const answered = () => {
    if (!address.has("import")) return;
    address.delete("import");
    setAddress(address, { replace: true });
  };
  return { asked, answered };
}
